"""What swims in what: body, scene, sections, the grid along the body, initial state, and checks of arguments."""
