// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "eel_core/build_info.hpp"

TEST(BuildInfo, FlagsAreThoseOfTheBuild)
{
    const eel_core::BuildInfo info = eel_core::build_info();
    EXPECT_NE(info.flags.find("-ffp-contract=fast"), std::string_view::npos);
    EXPECT_EQ(info.flags.find("fast-math"), std::string_view::npos);
    EXPECT_EQ(info.flags.find("-fsanitize") != std::string_view::npos, !info.sanitizers.empty());
}

TEST(BuildInfo, LevelIsTheOneAskedFor)
{
    const eel_core::BuildInfo info = eel_core::build_info();
    const auto at = info.flags.find("-march=x86-64");
    if (at == std::string_view::npos) GTEST_SKIP() << "no level asked for: " << info.level;
    EXPECT_EQ(info.flags.substr(at + 7, info.level.size()), info.level);
}

TEST(BuildInfo, NamesTheCompiler) { EXPECT_NE(eel_core::build_info().compiler, "other"); }
