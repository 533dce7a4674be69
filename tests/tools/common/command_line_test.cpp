#include "tools/common/command_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <utility>

namespace houghstream {
namespace {

/// The exit status of a fault, which says a line.
void expect_refused(CommandLine& line, const std::vector<std::string>& words) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(line.parse(words), 2) << words.back();
  EXPECT_NE(testing::internal::GetCapturedStderr().find(words.front()), std::string::npos) << words.back();
}

/// Returns the error for words that are refused.
std::string fault(CommandLine& line, const std::vector<std::string>& words) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(line.parse(words), 2);
  return testing::internal::GetCapturedStderr();
}

TEST(CommandLine, OptionsTakeWhatIsGivenAndKeepTheRest) {
  CommandLine line("words", "tool");
  int count = 3;
  float fraction = 0.5F;
  std::string file = "before";
  std::optional<double> limit;
  std::optional<int> untouched;
  bool loud = false;
  bool shown = true;
  line.add_option("file", file);
  line.add_option("-c,--count", count);
  line.add_option("--share", fraction);
  line.add_option("--limit", limit);
  line.add_option("--untouched", untouched);
  line.add_flag("--loud", loud, "words");
  line.add_clearing_flag("--no-show", shown, "words");
  EXPECT_EQ(line.parse({"a.txt", "-c", "7", "--limit", "0.25", "--loud", "--no-show"}), std::nullopt);
  EXPECT_EQ(file, "a.txt");
  EXPECT_EQ(count, 7);
  EXPECT_EQ(fraction, 0.5F);
  EXPECT_EQ(limit, 0.25);
  EXPECT_EQ(untouched, std::nullopt);
  EXPECT_TRUE(loud);
  EXPECT_FALSE(shown);
}

TEST(CommandLine, WhatIsOutsideItsLimitsIsRefused) {
  CommandLine line("words", "tool");
  int whole = 1;
  double part = 1.0;
  double fraction = 1.0;
  double weight = 1.0;
  int kernel = 3;
  line.add_option("--whole", whole).range(1, 5);
  line.add_option("--part", part).range(0.5, 2.0);
  line.add_option("--share", fraction).positive();
  line.add_option("--weight", weight).non_negative();
  line.add_option("--kernel", kernel).one_of({3, 5});
  EXPECT_EQ(line.parse({"--whole", "5", "--part", "0.5", "--weight", "0", "--kernel", "5"}), std::nullopt);
  expect_refused(line, {"--whole", "6"});
  expect_refused(line, {"--whole", "two"});
  expect_refused(line, {"--part", "0.4"});
  expect_refused(line, {"--share", "0"});
  expect_refused(line, {"--weight", "-1"});
  expect_refused(line, {"--kernel", "4"});
  for (const char* name : {"--part", "--share", "--weight"}) {
    for (const char* none : {"nan", "-nan", "inf", "-inf", "1e400"}) expect_refused(line, {name, none});
  }
}

TEST(CommandLine, NumbersAreFiniteAndFitTheirOption) {
  CommandLine line("words", "tool");
  float fraction = 0.0F;
  std::optional<double> limit;
  int count = 0;
  std::uint64_t seed = 0;
  line.add_option("--share", fraction);
  line.add_option("--limit", limit);
  line.add_option("--count", count);
  line.add_option("--seed", seed);
  EXPECT_EQ(line.parse({"--share", "-0.5", "--limit", "1e300", "--count", "-3", "--seed", "18446744073709551615"}),
            std::nullopt);
  EXPECT_EQ(seed, 18446744073709551615U);
  expect_refused(line, {"--share", "nan"});
  expect_refused(line, {"--share", "1e300"});
  expect_refused(line, {"--limit", "inf"});
  expect_refused(line, {"--count", "3000000000"});
  expect_refused(line, {"--count", ""});
  expect_refused(line, {"--seed", "-1"});
  expect_refused(line, {"--seed", "18446744073709551616"});
}

TEST(CommandLine, ARefusedNumberIsSaidWithWhatIsExpected) {
  CommandLine line("words", "tool");
  double part = 1.0;
  std::int64_t frames = 1;
  int kernel = 3;
  double unit_m = 1.0;
  line.add_option("--part", part).range(0.5, 2.0);
  line.add_option("--frames", frames).positive();
  line.add_option("--kernel", kernel).one_of({3, 5});
  line.add_option("--unit", unit_m).transform({{"mm", 1e-3}, {"m", 1.0}});
  EXPECT_NE(fault(line, {"--part", "3"}).find("--part: 3, expected 0.5 to 2\n"), std::string::npos);
  EXPECT_NE(fault(line, {"--part", "nan"}).find("--part: nan, expected a finite number\n"), std::string::npos);
  EXPECT_NE(fault(line, {"--part", "half"}).find("--part: half, expected a number\n"), std::string::npos);
  EXPECT_NE(fault(line, {"--frames", "0"}).find("--frames: 0, expected a number above 0\n"), std::string::npos);
  EXPECT_NE(fault(line, {"--frames", "2.5"}).find("--frames: 2.5, expected a whole number\n"), std::string::npos);
  EXPECT_NE(fault(line, {"--kernel", "4"}).find("--kernel: 4, expected one of 3, 5\n"), std::string::npos);
  EXPECT_NE(fault(line, {"--unit", "inch"}).find("--unit: inch, expected one of m, mm\n"), std::string::npos);
}

TEST(CommandLine, WhatIsMissingOrUnknownIsRefused) {
  CommandLine line("words", "tool");
  std::string out;
  line.add_option("--out", out).required();
  testing::internal::CaptureStderr();
  EXPECT_NE(line.parse({}).value_or(0), 0);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("--out"), std::string::npos);
  testing::internal::CaptureStderr();
  EXPECT_NE(line.parse({"--out", "x", "--nonsense"}).value_or(0), 0);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("--nonsense"), std::string::npos);
}

TEST(CommandLine, WordsAreSplitAndNamesBecomeValues) {
  CommandLine line("words", "tool");
  std::vector<std::string> names;
  double unit_m = 1.0;
  line.add_option("--names", names).delimiter(',');
  line.add_option("--unit", unit_m).transform({{"mm", 1e-3}, {"m", 1.0}});
  EXPECT_EQ(line.parse({"--names", "bowl,mug", "--unit", "mm"}), std::nullopt);
  EXPECT_EQ(names, (std::vector<std::string>{"bowl", "mug"}));
  EXPECT_EQ(unit_m, 1e-3);
  expect_refused(line, {"--unit", "inch"});
}

TEST(CommandLine, OneOfItsCommandsIsGiven) {
  CommandLine line("words", "tool");
  line.require_subcommand();
  int count = 0;
  CommandLine first = line.add_subcommand("first", "words");
  const CommandLine second = line.add_subcommand("second", "words");
  bool loud = false;
  first.add_option("--count", count);
  line.add_common_flag("-v,--loud", loud, "words");
  EXPECT_EQ(line.parse({"first", "--count", "2", "-v"}), std::nullopt);
  EXPECT_TRUE(loud) << "an option of the whole line, behind the command";
  EXPECT_TRUE(first.given());
  EXPECT_FALSE(second.given());
  EXPECT_EQ(count, 2);
  expect_refused(line, {"--before", "first", "--behind"});
  testing::internal::CaptureStderr();
  EXPECT_NE(line.parse({}).value_or(0), 0);
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
}

TEST(CommandLine, AFaultIsOneLineThatNamesProgramCommandAndWord) {
  CommandLine line("words", "tool");
  line.require_subcommand();
  CommandLine first = line.add_subcommand("first", "words");
  CommandLine second = line.add_subcommand("second", "words");
  second.require_subcommand();
  second.add_subcommand("inner", "words");
  std::string file;
  int start = 0;
  bool loud = false;
  first.add_option("file", file).required();
  first.add_option("--start", start);
  first.add_flag("--loud", loud, "words");
  const std::vector<std::pair<std::vector<std::string>, std::string>> faults = {
      {{}, "tool: without a command, expected first, second\n"},
      {{"bogus"}, "tool: unknown command 'bogus', expected first, second\n"},
      {{"second", "bogus", "x"}, "tool second: unknown command 'bogus', expected inner\n"},
      {{"--file", "first"}, "tool: unknown option --file (--help lists all)\n"},
      {{"first"}, "tool first: file is required\n"},
      {{"first", "a", "b"}, "tool first: 'b' is one word too many (--help lists what is expected)\n"},
      {{"first", "a", "--strat=3"}, "tool first: unknown option --strat, did you mean --start? (--help lists all)\n"},
      {{"first", "a", "--xyzzy", "3"}, "tool first: unknown option --xyzzy (--help lists all)\n"},
      {{"first", "a", "--start"}, "tool first: --start: without a value, expected one\n"},
      {{"first", "a", "--start", "abc"}, "tool first: --start: abc, expected a whole number\n"},
      {{"first", "a", "--start", "1", "--start", "2"}, "tool first: --start: is given more than once\n"},
      {{"first", "a", "--loud=maybe"}, "tool first: --loud: maybe, expected true or false\n"},
      {{"first", "a", "---"}, "tool first: unknown option --- (--help lists all)\n"},
  };
  for (const auto& [words, expected] : faults) EXPECT_EQ(fault(line, words), expected);
}

TEST(CommandLine, OfOptionsThatExcludeEachOtherOneIsGiven) {
  const auto expect_said = [](const std::vector<std::string>& words, const std::string& expected) {
    CommandLine line("words", "tool");
    bool join = false;
    bool part = false;
    const CommandOption joining = line.add_flag("--join", join, "words");
    line.add_flag("--part", part, "words").excludes(joining);
    testing::internal::CaptureStderr();
    EXPECT_EQ(line.parse(words).value_or(0) == 0, expected.empty());
    EXPECT_EQ(testing::internal::GetCapturedStderr(), expected);
  };
  expect_said({}, "");
  expect_said({"--join"}, "");
  expect_said({"--part"}, "");
  const std::string refused = "tool: --join and --part, expected at most one of them\n";
  expect_said({"--join", "--part"}, refused);
  expect_said({"--part", "--join"}, refused);
}

TEST(CommandLine, WhatIsMissingMayBeMisspelt) {
  CommandLine line("words", "tool");
  std::string out;
  line.add_option("--out", out).required();
  EXPECT_EQ(fault(line, {"--outt", "x"}), "tool: unknown option --outt, did you mean --out? (--help lists all)\n");
  EXPECT_EQ(fault(line, {}), "tool: --out is required\n");
  EXPECT_EQ(fault(line, {"--out", ""}), "tool: --out: nothing, expected a value\n");
}

TEST(CommandLine, HelpSaysWhatItIsFor) {
  CommandLine line("Counts sheep", "tool");
  int count = 17;
  line.add_option("--count", count, "sheep").capture_default_str();
  line.add_option("--other", count, "unsaid").default_str("many");
  line.get_option("--other").description("said");
  testing::internal::CaptureStdout();
  EXPECT_EQ(line.parse({"--help"}), 0);
  const std::string help = testing::internal::GetCapturedStdout();
  for (const char* words : {"Counts sheep", "tool", "sheep", "17", "many", "said"}) {
    EXPECT_NE(help.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(help.find("unsaid"), std::string::npos);
}

TEST(CommandLine, HelpEndsWithExamplesOfItsOwn) {
  CommandLine line("words", "tool");
  line.add_example("tool first");
  line.add_example("tool second --count 2");
  line.add_subcommand("first", "words");
  const auto help = [&](const std::vector<std::string>& words) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(line.parse(words), 0);
    return testing::internal::GetCapturedStdout();
  };
  const std::string examples = "\nExamples:\n  $ tool first\n  $ tool second --count 2\n";
  const std::string said = help({"--help"});
  EXPECT_EQ(said.substr(said.size() - std::min(said.size(), examples.size())), examples);
  EXPECT_EQ(help({"first", "--help"}).find("Examples"), std::string::npos);
}

/// Holds a command line with options of a file.
struct Configured {
  CommandLine line{"words", "tool"};
  int count = 3;
  std::string objects = "none";
  std::optional<double> fraction;
  bool loud = false;
  std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "command_line_test.toml";

  explicit Configured(const std::string& text) {
    line.add_option("--count", count, "how many").capture_default_str();
    line.add_option("--objects", objects, "which");
    line.add_option("--share", fraction, "how much").range(0.0, 1.0);
    line.add_flag("--loud", loud, "how");
    line.set_version("tool 1");
    line.add_config_file();
    std::ofstream(file) << text;
  }
};

TEST(CommandLine, OptionsComeFromAFileAndTheCommandLineGoesBefore) {
  Configured given("# what is known\nobjects = \"my.store\"\ncount = 5\n");
  EXPECT_EQ(given.line.parse({"--config", given.file.string(), "--count", "7"}), std::nullopt);
  EXPECT_EQ(given.objects, "my.store");
  EXPECT_EQ(given.count, 7);
}

TEST(CommandLine, BlanksOfAnyKindStandAboutKeysAndValues) {
  Configured given("\tcount\t=\t5\t# tabs\r\n  share = 0.5\n");
  EXPECT_EQ(given.line.parse({"--config", given.file.string()}), std::nullopt);
  EXPECT_EQ(given.count, 5);
  EXPECT_EQ(given.fraction, 0.5);
}

TEST(CommandLine, AnUnknownKeyOfAFileIsRefusedWithTheNearestOne) {
  Configured given("object = \"my.store\"\n");
  EXPECT_EQ(fault(given.line, {"--config", given.file.string()}),
            "tool: " + given.file.string() +
                ": 'object' is no key, expected one of the options' long names; the nearest is 'objects'\n");
}

/// Returns the error for a file, behind its name.
std::string fault_of_file(const std::string& text) {
  Configured given(text);
  const std::string said = fault(given.line, {"--config", given.file.string()});
  const std::string named = "tool: " + given.file.string() + ": ";
  EXPECT_EQ(said.rfind(named, 0), 0U) << said;
  return said.substr(std::min(named.size(), said.size()));
}

TEST(CommandLine, AFaultOfAFileNamesIt) {
  EXPECT_EQ(fault_of_file("count = \"many\"\n"), "--count: many, expected a whole number\n");
  EXPECT_EQ(fault_of_file("\tcount\t=\t5 s\n"), "--count: 5 s, expected a whole number\n");
  EXPECT_EQ(fault_of_file("loud = perhaps\n"), "--loud: perhaps, expected true or false\n");
  EXPECT_EQ(fault_of_file("# one\n\n[section]\n"), "line 3: [section], expected key = value: there are no sections\n");
  EXPECT_EQ(fault_of_file("count = 1\nobjects = a\ncount = 2\n"), "line 3: 'count' is in line 1 already\n");
  EXPECT_EQ(fault_of_file("objects = \"my.store\n"), "line 1: \"my.store has no end, expected a second \"\n");
  EXPECT_EQ(fault_of_file("objects = 'a' b\n"), "line 1: 'b' behind a text in quotes, expected nothing more\n");
  EXPECT_EQ(fault_of_file("objects\n"), "line 1: objects, expected key = value\n");
  EXPECT_EQ(fault_of_file("count = # none\n"), "line 1: count has no value, expected key = value\n");
  for (const std::string key : {"version", "help", "config"})
    EXPECT_EQ(fault_of_file(key + " = true\n").rfind("'" + key + "' is no key", 0), 0U) << key;
}

TEST(CommandLine, AFileThatCannotBeReadIsNamed) {
  for (const std::string& file : {std::string(testing::TempDir()), std::string("/nowhere.toml")}) {
    Configured given("");
    EXPECT_EQ(fault(given.line, {"--config", file}),
              "tool: " + file + ": cannot be read, expected a file of lines key = value\n");
  }
}

TEST(CommandLine, WhatTheCommandLineSaysIsNoFaultOfTheFile) {
  Configured given("count = 5\n");
  EXPECT_EQ(fault(given.line, {"--config", given.file.string(), "--count", "many"}),
            "tool: --count: many, expected a whole number\n");
}

TEST(CommandLine, ATextOfAFileMayHoldAnything) {
  Configured given("objects = \"my # store, 'old' = 5\"  # which\n'count' = 4  # how many\nloud = true\n");
  EXPECT_EQ(given.line.parse({"--config", given.file.string()}), std::nullopt);
  EXPECT_EQ(given.objects, "my # store, 'old' = 5");
  EXPECT_EQ(given.count, 4);
  EXPECT_TRUE(given.loud);
}

TEST(CommandLine, ATemplateOfAFileIsSuchAFile) {
  Configured first("");
  EXPECT_EQ(first.line.parse({}), std::nullopt);
  const std::string text = first.line.config_template();
  EXPECT_NE(text.find("how many"), std::string::npos) << text;
  Configured second(text);
  EXPECT_EQ(second.line.parse({"--config", second.file.string()}), std::nullopt);
  EXPECT_EQ(second.count, 3);
  EXPECT_EQ(second.objects, "none") << text;
  EXPECT_EQ(second.fraction, std::nullopt) << text;
}

TEST(CommandLine, ATemplateHoldsNoOptionOfASubcommand) {
  Configured first("");
  bool verbose = false;
  int depth = 0;
  CommandLine job = first.line.add_subcommand("init", "prints a file");
  job.add_subcommand("deeper", "words").add_option("--depth", depth, "how deep").capture_default_str();
  first.line.add_common_flag("-v,--verbose", verbose, "log more");
  EXPECT_EQ(first.line.parse({"init"}), std::nullopt);
  const std::string text = first.line.config_template();
  EXPECT_NE(text.find("\nverbose=false\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("init"), std::string::npos) << text;
  EXPECT_EQ(text.find("deep"), std::string::npos) << text;
  Configured second(text);
  second.line.add_common_flag("-v,--verbose", verbose, "log more");
  EXPECT_EQ(second.line.parse({"--config", second.file.string()}), std::nullopt) << text;
}

}  // namespace
}  // namespace houghstream
