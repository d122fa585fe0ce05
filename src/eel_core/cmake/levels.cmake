# SPDX-License-Identifier: Apache-2.0
# Sets `modules` to the names of the modules to build, and march_of_NAME to the flag of each.
# A module for a level dies on a processor below it, so each level has a module of its own; eel_core/levels.py chooses.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  if(EEL_CORE_LEVELS)
    message(FATAL_ERROR "EEL_CORE_LEVELS is for x86-64, got \"${EEL_CORE_LEVELS}\" on ${CMAKE_SYSTEM_PROCESSOR}")
  endif()
  set(modules _core)
  set(march_of__core "")
  return()
endif()

set(levels ${EEL_CORE_LEVELS})
if(NOT levels)
  execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/eel_core/processor.py
    OUTPUT_VARIABLE levels OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
endif()
set(modules "")
foreach(level IN LISTS levels)
  if(level STREQUAL "native")
    set(march_of__core_native -march=native)
  elseif(level MATCHES "^v[234]$")
    set(march_of__core_${level} -march=x86-64-${level})
  else()
    message(FATAL_ERROR "EEL_CORE_LEVELS must be of v2;v3;v4;native, got \"${EEL_CORE_LEVELS}\"")
  endif()
  list(APPEND modules _core_${level})
endforeach()
