// The Python module. EEL_CORE_MODULE is its name: one for each level of the processor.
#include <pybind11/pybind11.h>

#include "eel_core/build_info.hpp"

namespace py = pybind11;

PYBIND11_MODULE(EEL_CORE_MODULE, module)
{
    // One name for all levels: what is pickled by one can be read by another.
    module.attr("__name__") = "eel_core._core";

    module.def(
        "build_info",
        [] {
            const eel_core::BuildInfo info = eel_core::build_info();
            py::dict result;
            result["level"] = info.level;
            result["compiler"] = info.compiler;
            result["flags"] = info.flags;
            result["sanitizers"] = info.sanitizers;
            result["pybind11"] =
                PYBIND11_TOSTRING(PYBIND11_VERSION_MAJOR) "." PYBIND11_TOSTRING(PYBIND11_VERSION_MINOR);
            return result;
        },
        "How this module was compiled: level, compiler, flags, sanitizers, pybind11.");
}
