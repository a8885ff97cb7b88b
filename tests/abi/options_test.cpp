// The option table as hosts read it, and the setters.
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "abi/host.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using namespace host;

TEST(Options, KeysCountWithoutGapsAndDescribeThemselves) {
  std::set<std::string> names;
  int32_t key = 0;
  auto info = sized<beltrami_option_info>();
  for (; beltrami_option_describe(key, &info) == BELTRAMI_OK; ++key) {
    SCOPED_TRACE(info.name);
    EXPECT_EQ(info.key, key);
    EXPECT_EQ(info.reserved, 0);
    EXPECT_EQ(info.struct_size, sizeof info);
    EXPECT_EQ(beltrami_option_find(info.name), key);
    EXPECT_TRUE(names.insert(info.name).second);
    EXPECT_EQ(std::string(info.name).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"),
              std::string::npos);
    EXPECT_EQ(std::string(info.summary).back(), '.');
    EXPECT_LE(info.minimum, info.default_value);
    EXPECT_LE(info.default_value, info.maximum);
    if (info.type != BELTRAMI_TYPE_FLOAT) {
      EXPECT_EQ(info.minimum, std::floor(info.minimum));
      EXPECT_LT(info.maximum, 9e15) << "an exact integer";
    }
  }
  EXPECT_GT(key, BELTRAMI_OPTION_INJECTIVITY) << "an option of the header is missing";
  EXPECT_EQ(beltrami_option_describe(key + 1, &info), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Options, ChoicesHaveANameForEachValue) {
  auto info = sized<beltrami_option_info>();
  for (int32_t key = 0; beltrami_option_describe(key, &info) == BELTRAMI_OK; ++key) {
    int32_t values = 0;
    while (beltrami_option_choice(key, values) != nullptr) ++values;
    EXPECT_EQ(values, info.type == BELTRAMI_TYPE_CHOICE ? info.maximum + 1 : 0) << info.name;
    EXPECT_EQ(beltrami_option_choice(key, -1), nullptr);
  }
  EXPECT_STREQ(beltrami_option_choice(BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_BELTRAMI),
               "beltrami");
  EXPECT_STREQ(beltrami_option_choice(BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_CM), "cm");
  EXPECT_STREQ(beltrami_option_choice(BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_TUTTE), "tutte");
  EXPECT_EQ(beltrami_option_choice(99, 0), nullptr);
}

TEST(Options, AnswersUnknownOnesWithoutHarm) {
  auto info = sized<beltrami_option_info>();
  EXPECT_EQ(beltrami_option_find(nullptr), -1);
  EXPECT_EQ(beltrami_option_find(""), -1);
  EXPECT_EQ(beltrami_option_find("Method"), -1);
  EXPECT_EQ(beltrami_option_describe(-1, &info), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_option_describe(std::numeric_limits<int32_t>::max(), &info),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_option_describe(0, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Options, TakesBothEndsOfTheRangeAndNothingBeyond) {
  const Context context = create();
  auto info = sized<beltrami_option_info>();
  for (int32_t key = 0; beltrami_option_describe(key, &info) == BELTRAMI_OK; ++key) {
    SCOPED_TRACE(info.name);
    if (info.type == BELTRAMI_TYPE_FLOAT) {
      const auto set = [&](double value) { return beltrami_set_float(context.get(), key, value); };
      EXPECT_EQ(set(info.minimum), BELTRAMI_OK);
      EXPECT_EQ(set(info.maximum), BELTRAMI_OK);
      EXPECT_EQ(set(std::nextafter(info.minimum, -HUGE_VAL)), BELTRAMI_E_INVALID_ARGUMENT);
      EXPECT_EQ(set(std::nextafter(info.maximum, HUGE_VAL)), BELTRAMI_E_INVALID_ARGUMENT);
      EXPECT_EQ(set(std::nan("")), BELTRAMI_E_INVALID_ARGUMENT);
    } else {
      const auto set = [&](int64_t value) { return beltrami_set_int(context.get(), key, value); };
      const auto minimum = static_cast<int64_t>(info.minimum);
      const auto maximum = static_cast<int64_t>(info.maximum);
      EXPECT_EQ(set(minimum), BELTRAMI_OK);
      EXPECT_EQ(set(maximum), BELTRAMI_OK);
      EXPECT_EQ(set(minimum - 1), BELTRAMI_E_INVALID_ARGUMENT);
      EXPECT_EQ(set(maximum + 1), BELTRAMI_E_INVALID_ARGUMENT);
      EXPECT_EQ(set(std::numeric_limits<int64_t>::min()), BELTRAMI_E_INVALID_ARGUMENT);
      EXPECT_EQ(set(std::numeric_limits<int64_t>::max()), BELTRAMI_E_INVALID_ARGUMENT);
    }
    EXPECT_NE(message(context).find(info.name), std::string::npos) << message(context);
    EXPECT_EQ(beltrami_error_element(context.get()), BELTRAMI_NO_ELEMENT);
  }
}

TEST(Options, RefusesTheWrongSetter) {
  const Context context = create();
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_TOLERANCE, 0),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("beltrami_set_float"), std::string::npos);
  EXPECT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_THREADS, 1),
            BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_NE(message(context).find("beltrami_set_int"), std::string::npos);
  EXPECT_EQ(beltrami_set_int(context.get(), 1000, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_set_float(context.get(), -1, 0), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Options, NamesTheChoicesWhereNoneWasGiven) {
  const Context context = create();
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, 99),
            BELTRAMI_E_INVALID_ARGUMENT);
  int32_t value = 0;
  while (const char* choice = beltrami_option_choice(BELTRAMI_OPTION_METHOD, value++)) {
    EXPECT_NE(message(context).find(choice), std::string::npos) << message(context);
  }
}

TEST(Options, ARefusedValueLeavesTheOldOne) {
  const Context context = loaded(meshes::bumps(4, 4));
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_METHOD, 99),
            BELTRAMI_E_INVALID_ARGUMENT);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  auto stage = sized<beltrami_stage>();
  ASSERT_EQ(beltrami_get_stage(context.get(), 0, &stage), BELTRAMI_OK);
  EXPECT_STREQ(stage.name, "tutte");
}

struct Pair {
  std::vector<std::pair<std::int32_t, std::int64_t>> settings;
  const char* named;  ///< in the message, or null where the pair makes sense
};

TEST(Options, ThatWouldHaveNoEffectAreRefusedByTheRun) {
  constexpr auto kMethod = BELTRAMI_OPTION_METHOD;
  const std::vector<Pair> pairs = {
      {{{kMethod, BELTRAMI_METHOD_CM}, {BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_BFF}},
       "flatten=bff has no effect with method=cm"},
      {{{BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_GIF}, {kMethod, BELTRAMI_METHOD_GIF}},
       "flatten=gif has no effect with method=gif"},
      {{{kMethod, BELTRAMI_METHOD_CM}, {BELTRAMI_OPTION_DELAUNAY, 1}},
       "delaunay=on has no effect with method=cm"},
      {{{kMethod, BELTRAMI_METHOD_BFF}, {BELTRAMI_OPTION_INJECTIVITY, BELTRAMI_INJECTIVITY_LOCAL}},
       "injectivity=local has no effect with method=bff"},
      {{{BELTRAMI_OPTION_REFINE_ITERATIONS, 3}}, "refine-iterations=3 has no effect with refine=0"},
      {{{kMethod, BELTRAMI_METHOD_CM}}, nullptr},
      {{{kMethod, BELTRAMI_METHOD_TUTTE}, {BELTRAMI_OPTION_COARSE_FACES, 100}}, nullptr},
      {{{kMethod, BELTRAMI_METHOD_CM}, {BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_METRIC}},
       nullptr},
      {{{kMethod, BELTRAMI_METHOD_GIF}, {BELTRAMI_OPTION_DELAUNAY, 1}}, nullptr},
      {{{kMethod, BELTRAMI_METHOD_TUTTE},
        {BELTRAMI_OPTION_REFINE, 1},
        {BELTRAMI_OPTION_REFINE_ITERATIONS, 3},
        {BELTRAMI_OPTION_INJECTIVITY, BELTRAMI_INJECTIVITY_GLOBAL}},
       nullptr},
  };
  const meshes::TriangleList mesh = meshes::bumps(4, 4);
  for (const auto& [settings, named] : pairs) {
    const Context context = create();
    ASSERT_EQ(set_mesh(context, mesh), BELTRAMI_OK);
    for (const auto& [key, value] : settings) {
      ASSERT_EQ(beltrami_set_int(context.get(), key, value), BELTRAMI_OK) << message(context);
    }
    const beltrami_status status = run(context);
    if (named == nullptr) {
      EXPECT_GE(status, BELTRAMI_OK) << message(context);
      continue;
    }
    EXPECT_EQ(status, BELTRAMI_E_INVALID_ARGUMENT) << named;
    EXPECT_NE(message(context).find(named), std::string::npos) << message(context);
    EXPECT_NE(message(context).find("leave it out"), std::string::npos) << message(context);
  }
}

TEST(Options, ReachEveryValidPairInAnyOrder) {
  const Context context = loaded(meshes::bumps(4, 4));
  set_option(context, BELTRAMI_OPTION_FLATTEN, BELTRAMI_FLATTEN_DIRICHLET);
  EXPECT_EQ(run(context), BELTRAMI_E_INVALID_ARGUMENT) << "the method is tutte";
  set_option(context, BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_BELTRAMI);
  EXPECT_EQ(run(context), BELTRAMI_OK) << message(context);
}

TEST(Options, ATimeLimitCutsTheIterationsOfAnyMethod) {
  for (const std::int32_t method : {BELTRAMI_METHOD_BELTRAMI, BELTRAMI_METHOD_CM}) {
    const Context context = loaded(meshes::bumps(8, 8));
    set_option(context, BELTRAMI_OPTION_METHOD, static_cast<std::uint64_t>(method));
    ASSERT_EQ(beltrami_set_float(context.get(), BELTRAMI_OPTION_TIME_LIMIT, 1e-9), BELTRAMI_OK);
    EXPECT_EQ(run(context), BELTRAMI_NOT_CONVERGED) << message(context);
    auto certificate = sized<beltrami_certificate>();
    ASSERT_EQ(beltrami_get_certificate(context.get(), &certificate), BELTRAMI_OK);
    EXPECT_EQ(certificate.injective, 1);
  }
}

TEST(Options, UnitSquareHoldsEveryUv) {
  const meshes::TriangleList mesh = meshes::bumps(5, 9);
  const Context context = loaded(mesh);
  ASSERT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_UNIT_SQUARE, 1), BELTRAMI_OK);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  double greatest = 0;
  for (const auto& uv : uvs(context, mesh.positions.size())) {
    for (const double x : uv) {
      EXPECT_GE(x, 0);
      EXPECT_LE(x, 1);
      greatest = std::max(greatest, x);
    }
  }
  EXPECT_GT(greatest, 0.999);
}

}  // namespace
}  // namespace beltrami
