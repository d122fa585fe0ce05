"""What exactness costs, and what leaving physics out costs: `tradeoff` measures both for a gait, and draws them."""
