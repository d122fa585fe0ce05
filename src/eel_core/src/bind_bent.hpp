// SPDX-License-Identifier: Apache-2.0
// The Python classes of bodies with modes.
#pragma once

#include <pybind11/pybind11.h>

namespace eel_core {

void bind_bent_marches(pybind11::module_& module);

}  // namespace eel_core
