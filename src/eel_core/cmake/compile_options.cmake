# SPDX-License-Identifier: Apache-2.0
# How everything here is compiled. The level of the processor is apart (levels.cmake).
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)   # -O3
endif()
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT DEFINED CMAKE_UNITY_BUILD)   # all files of a target in one piece: each compiles the same templates
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 0)
endif()

# A product and a sum may become one rounding; sums keep their order, and NaN and infinity are seen: no -ffast-math.
# Nobody looks at errno or at floating-point traps after arithmetic.
set(eel_core_compile_options -ffp-contract=fast -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Order instructions before registers are given out too: long formulas in vectors gain, and x86 leaves it off.
  list(APPEND eel_core_compile_options -fschedule-insns -fsched-pressure)
endif()
set(eel_core_link_options "")
if(EEL_CORE_SANITIZE)
  set(sanitizers -fsanitize=${EEL_CORE_SANITIZE} -fno-sanitize-recover=all)
  list(APPEND eel_core_compile_options ${sanitizers} -fno-omit-frame-pointer -g -D_GLIBCXX_ASSERTIONS)
  list(APPEND eel_core_link_options ${sanitizers})
endif()
set(eel_core_warnings -Wall -Wextra -Wconversion -Wshadow)

function(eel_core_compile target march)
  target_link_libraries(${target} PRIVATE eel_core)
  target_compile_options(${target} PRIVATE ${eel_core_compile_options} ${march} ${eel_core_warnings})
  target_link_options(${target} PRIVATE ${eel_core_link_options})
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${eel_core_compile_options} ${march})
  target_compile_definitions(${target} PRIVATE "EEL_CORE_FLAGS=\"${flags}\"")
endfunction()
