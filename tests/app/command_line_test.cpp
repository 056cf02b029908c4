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

TEST(CommandLine, TakesOptionsInBothStyles)
{
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"-dp:0.01", "-threads:3", "-fit:raw", "-strict",
                                   "-evars:A=1:B=2"},
          {"--dp", "0.01", "--threads", "3", "--fit", "raw", "--strict", "--evars", "A=1:B=2"},
          {"--dp=0.01", "--threads=3", "--fit=raw", "--strict", "--evars=A=1:B=2"},
          {"--dp:0.01", "--threads:3", "--fit:raw", "--strict", "--evars:A=1:B=2"}})
    {
        const DropInOptions options = options_of(words);
        EXPECT_EQ(options.dp, 0.01) << words[0];
        EXPECT_EQ(options.threads, 3);
        EXPECT_EQ(options.fit, FitChoice::Raw);
        EXPECT_TRUE(options.strict);
        ASSERT_EQ(options.evars.size(), 2U);
        EXPECT_EQ(options.evars[1].second, "2");
        EXPECT_EQ(options.output, "out/Case");
    }
    EXPECT_EQ(options_of({"--fit", "--strict"}).fit, FitChoice::On);
}

std::string error_of(const std::vector<std::string>& words)
{
    try
    {
        options_of(words);
    }
    catch (const UsageError& error)
    {
        return error.what();
    }
    return "no error";
}

TEST(CommandLine, SaysHowAValueIsGiven)
{
    EXPECT_EQ(error_of({"-dp", "0.02"}), "-dp needs a value: -dp:0.02 or --dp 0.02");
    EXPECT_EQ(error_of({"--dp"}), "--dp needs a value: -dp:0.01 or --dp 0.01");
    EXPECT_EQ(error_of({"-save"}), "-save needs a value: -save:all or --save all");
}

TEST(CommandLine, NamesTheNearestOption)
{
    EXPECT_EQ(
        error_of({"-strcit"}),
        "the option -strcit is unknown (did you mean -strict?); fppg --help lists all options");
    EXPECT_EQ(error_of({"--thread:2"}),
              "the option --thread:2 is unknown (did you mean -threads?); "
              "fppg --help lists all options");
    EXPECT_EQ(error_of({"-xyz"}), "the option -xyz is unknown; fppg --help lists all options");
}

TEST(CommandLine, TakesTheDefinitionWithItsEnding)
{
    EXPECT_EQ(parse_command_line({"a/Case_Def.xml", "out/Case"}).input, "a/Case_Def");
    EXPECT_EQ(parse_command_line({"a/Case_Def.xml", "out/*"}).output, "out/Case_Def");
    EXPECT_EQ(parse_command_line({"a/Case_Def.xml"}).output, "a/Case_Def");
}

} // namespace
} // namespace fppg
