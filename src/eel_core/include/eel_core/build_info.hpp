// SPDX-License-Identifier: Apache-2.0
// Compiler, flags and instruction set of the including file.
#pragma once

#include <string_view>

#ifndef EEL_CORE_FLAGS  // included from another build
#define EEL_CORE_FLAGS ""
#endif

namespace eel_core {

struct BuildInfo {
    std::string_view level;       // x86-64 level that the code needs, or the name of another architecture
    std::string_view compiler;    // name and version
    std::string_view flags;       // as given by the build
    std::string_view sanitizers;  // empty: none
};

inline constexpr std::string_view target_level =
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512CD__) && defined(__AVX512DQ__) && \
    defined(__AVX512VL__)
    "x86-64-v4";
#elif defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__)
    "x86-64-v3";
#elif defined(__SSE4_2__) && defined(__SSSE3__)
    "x86-64-v2";
#elif defined(__x86_64__)
    "x86-64";
#elif defined(__aarch64__)
    "aarch64";
#else
    "other";
#endif

inline constexpr std::string_view compiler_name =
#if defined(__clang__)
    "Clang " __clang_version__;
#elif defined(__GNUC__)
    "GCC " __VERSION__;
#else
    "other";
#endif

constexpr std::string_view active_sanitizers()
{
#if defined(__SANITIZE_ADDRESS__)  // GCC
    return "address,undefined";
#elif defined(__SANITIZE_THREAD__)
    return "thread";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
    return "address,undefined";
#endif
#endif
    return "";
}

constexpr BuildInfo build_info() { return {target_level, compiler_name, EEL_CORE_FLAGS, active_sanitizers()}; }

}  // namespace eel_core
