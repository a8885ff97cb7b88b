// Options, reports and the progress line.
#include <gtest/gtest.h>
#if defined(__linux__)
#include <sched.h>
#endif

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "commands/options.h"
#include "commands/progress_bar.h"
#include "commands/report.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

Option number_option(std::int32_t type, double minimum, double maximum) {
  Option option;
  option.info.type = type;
  option.info.minimum = minimum;
  option.info.maximum = maximum;
  return option;
}

TEST(ParseOption, TakesWholeNumbersInRange) {
  Option option = number_option(BELTRAMI_TYPE_INT, 0, 100);
  EXPECT_EQ(parse_option("010", option), "");
  EXPECT_EQ(option.integer, 10) << "not octal";
  for (const char* text : {"", "1.5", "101", "-1", "7x", "99999999999999999999", "0x10"}) {
    EXPECT_EQ(parse_option(text, option),
              std::string("'") + text + "' is not a whole number from 0 to 100");
    EXPECT_EQ(option.integer, 10) << "the old value stays";
  }
}

TEST(ParseOption, TakesNumbersInRange) {
  Option option = number_option(BELTRAMI_TYPE_FLOAT, 0, 1);
  EXPECT_EQ(parse_option("1e-4", option), "");
  EXPECT_EQ(option.real, 1e-4);
  for (const char* text : {"nan", "inf", "1,5", "2"}) EXPECT_NE(parse_option(text, option), "");
}

TEST(ParseOption, TakesBytesInUnits) {
  Option option = number_option(BELTRAMI_TYPE_INT, 0, 5e9);
  option.info.key = BELTRAMI_OPTION_MEMORY_LIMIT;
  for (const auto& [text, bytes] : {std::pair<const char*, std::int64_t>{"1000", 1000},
                                    {"3K", 3 << 10},
                                    {"512M", 512 << 20},
                                    {"4G", std::int64_t{4} << 30}}) {
    EXPECT_EQ(parse_option(text, option), "");
    EXPECT_EQ(option.integer, bytes) << text;
  }
  for (const char* text : {"5G", "-1K", "1.5G", "K", "1T", "1 G", "9999999999999999999G"}) {
    EXPECT_NE(parse_option(text, option).find(text), std::string::npos) << text;
    EXPECT_EQ(option.integer, std::int64_t{4} << 30) << "the old value stays";
  }
}

TEST(ParseOption, TakesNamedChoices) {
  Option option = number_option(BELTRAMI_TYPE_CHOICE, 0, 1);
  option.choices = {"red", "green"};
  EXPECT_EQ(parse_option("green", option), "");
  EXPECT_EQ(option.integer, 1);
  EXPECT_EQ(parse_option("blue", option), "'blue' is not one of red, green");
}

TEST(Options, HaveTheLibrarysDefaults) {
  Report report;
  report.options = Options(BELTRAMI_CALL_RUN).values();
  const auto json = nlohmann::json::parse(to_json(report))["options"];
  EXPECT_EQ(json["method"], "beltrami");
  EXPECT_EQ(json["unit-square"], false);
  EXPECT_GT(json["tolerance"], 0.0);
}

#if defined(__linux__)
TEST(Options, UseAllCoresThatTheProcessMayUseUnlessTold) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(Options(BELTRAMI_CALL_RUN).integer(BELTRAMI_OPTION_THREADS), CPU_COUNT(&before));
  cpu_set_t one;
  CPU_ZERO(&one);
  for (std::size_t core = 0; CPU_COUNT(&one) == 0; ++core) {
    if (CPU_ISSET(core, &before)) CPU_SET(core, &one);
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(Options(BELTRAMI_CALL_RUN).integer(BELTRAMI_OPTION_THREADS), 1);
  EXPECT_FALSE(Options(BELTRAMI_CALL_RUN).use_fewer_threads());
  sched_setaffinity(0, sizeof before, &before);
}
#endif

TEST(Report, NeverHoldsNumbersThatJsonHasNot) {
  Report report;
  report.input_path = "\xFF.obj";
  report.area = std::numeric_limits<double>::infinity();
  report.energy.emplace();
  report.energy->symmetric_dirichlet = std::numeric_limits<double>::quiet_NaN();
  report.energy->worst_face = BELTRAMI_NO_ELEMENT;
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_TRUE(json["input"]["area"].is_null());
  EXPECT_TRUE(json["energy"]["symmetric_dirichlet"].is_null());
  EXPECT_TRUE(json["energy"]["worst_face"].is_null());
  EXPECT_TRUE(json["injective"].is_null());
}

TEST(ProgressLine, IsShortAndBounded) {
  EXPECT_EQ(progress_line(0.5, "flatten", 3.2, 200),
            "flatten    [###############...............]  50%     3.2 s");
  for (const double fraction : {-1.0, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(progress_line(fraction, "a stage with a long name", 1, 200).size(), 58u);
  }
}

TEST(ProgressLine, FitsTheTerminal) {
  for (int columns = 0; columns < 100; ++columns) {
    const std::string line = progress_line(0.5, "flatten", 3.2, columns);
    EXPECT_LT(line.size(), static_cast<std::size_t>(columns) + (columns == 0 ? 1 : 0));
    EXPECT_EQ(line.find("50%") != std::string::npos, columns > 4) << columns;
  }
  EXPECT_EQ(progress_line(0.5, "flatten", 3.2, 40), "flatten    [#####......]  50%     3.2 s");
  EXPECT_EQ(progress_line(0.5, "flatten", 3.2, 30), "flatten     50%     3.2 s");
}

TEST(OneLine, HasNoControlCharacters) {
  EXPECT_EQ(one_line("a\nb\r\x1b[2K"), "a b  [2K");
}

}  // namespace
}  // namespace beltrami::cli
