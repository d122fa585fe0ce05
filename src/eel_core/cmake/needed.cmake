# SPDX-License-Identifier: Apache-2.0
# What the build needs. Each shortage ends it with the package that brings what is missing.
include(CheckLanguage)
check_language(CXX)
if(NOT CMAKE_CXX_COMPILER)
  message(FATAL_ERROR "missing: a C++ compiler. On Debian or Ubuntu: sudo apt-get install g++")
endif()
enable_language(CXX)

include(CheckCXXSourceCompiles)
set(CMAKE_CXX_SCAN_FOR_MODULES OFF)   # there are none, and the scanner may be missing
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES CMAKE_CXX_SCAN_FOR_MODULES)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if("cxx_std_20" IN_LIST CMAKE_CXX_COMPILE_FEATURES)
  check_cxx_source_compiles("
    #include <concepts>
    #include <numbers>
    #include <span>
    template <std::floating_point Real> Real half_turn() { return std::numbers::pi_v<Real>; }
    int main() { double a[1] = {half_turn<double>()}; return std::span<double>(a).size() == 1 ? 0 : 1; }
    " EEL_CORE_HAS_CXX20)
endif()
if(NOT EEL_CORE_HAS_CXX20)
  message(FATAL_ERROR "missing: C++20 (${CMAKE_CXX_COMPILER} is ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}; "
    "GCC 11, Clang 14 or later have it). On Debian or Ubuntu: sudo apt-get install g++")
endif()

if(NOT CMAKE_CROSSCOMPILING)
  find_package(Python3 QUIET COMPONENTS Interpreter)
  if(NOT Python3_Interpreter_FOUND)
    message(FATAL_ERROR "missing: Python 3. On Debian or Ubuntu: sudo apt-get install python3")
  endif()
endif()

if(EEL_CORE_MODULE)
  find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
  if(NOT Python3_Development.Module_FOUND)
    message(FATAL_ERROR "missing: the C headers of ${Python3_EXECUTABLE}. On Debian or Ubuntu: sudo apt-get install python3-dev")
  endif()
  # The interpreter's own pybind11 goes before the system's. (`--cmakedir` quotes a path with a space.)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import pybind11; print(pybind11.get_cmake_dir())"
    OUTPUT_VARIABLE pybind11_of_python OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  find_package(pybind11 2.11 QUIET CONFIG HINTS "${pybind11_of_python}")
  if(NOT pybind11_FOUND)
    message(FATAL_ERROR "missing: pybind11 2.11 or later. On Debian or Ubuntu: sudo apt-get install pybind11-dev; "
      "in a virtual environment: pip install pybind11")
  endif()
endif()
