// One program of units that are compiled with exceptions and without, as C++17 and as C++20.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include "cpp/units.h"

namespace beltrami::host {
namespace {

TEST(CppUnits, WithoutExceptionsThereAreResults) {
  EXPECT_EQ(unwrap_without_exceptions(), BELTRAMI_E_INDEX_OUT_OF_RANGE);
}

TEST(CppUnits, SpansOfTheStandardAreTaken) {
  EXPECT_EQ(flatten_spans(), 3u);
}

}  // namespace
}  // namespace beltrami::host
