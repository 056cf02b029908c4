#include "app/command_line.h"

#include "fppg/error.h"

#include <gtest/gtest.h>

namespace fppg
{
namespace
{

DropInOptions options_of(std::vector<std::string> words)
{
    words.insert(words.begin(), {"Case_Def", "out/Case"});
    return parse_command_line(words);
}

TEST(CommandLine, LeavesBodyFittingToTheCaseUnlessAsked)
{
    EXPECT_EQ(options_of({}).fit, FitChoice::AsCase);
    EXPECT_EQ(options_of({"-fit"}).fit, FitChoice::On);
    EXPECT_EQ(options_of({"-fit:raw"}).fit, FitChoice::Raw);
    EXPECT_EQ(options_of({"-fit:off"}).fit, FitChoice::Off);
    EXPECT_EQ(options_of({"-fit", "-fit:off"}).fit, FitChoice::Off);
}

TEST(CommandLine, RefusesAFitThatIsNeitherRawNorOff)
{
    EXPECT_THROW(options_of({"-fit:"}), UsageError);
    EXPECT_THROW(options_of({"-fit:1"}), UsageError);
    EXPECT_THROW(options_of({"-fitted"}), UsageError);
}

TEST(CommandLine, SavesFeatureLinesOnRequestAndWithAll)
{
    EXPECT_FALSE(options_of({}).save_features);
    EXPECT_TRUE(options_of({"-save:+vtkfeatures"}).save_features);
    EXPECT_TRUE(options_of({"-save:all"}).save_features);
    EXPECT_FALSE(options_of({"-save:all,-vtkfeatures"}).save_features);
}

} // namespace
} // namespace fppg
