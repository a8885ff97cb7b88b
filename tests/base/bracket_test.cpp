// A bracket closes around the place that is looked for, from whatever is known of it.
#include "base/bracket.h"

#include <gtest/gtest.h>

#include <cmath>

namespace beltrami {
namespace {

TEST(Bracket, IsOpenUntilBothEndsAreKnown) {
  Bracket bracket;
  EXPECT_FALSE(bracket.has_low() || bracket.has_high() || bracket.is_closed());
  EXPECT_EQ(bracket.inside(7), 7);
  bracket.note(3, false);
  EXPECT_TRUE(bracket.has_low());
  EXPECT_EQ(bracket.inside(1), 1) << "a guess is all there is";
  EXPECT_FALSE(bracket.is_within(1e300));
  bracket.note(5, true);
  EXPECT_TRUE(bracket.is_closed());
}

TEST(Bracket, KeepsGuessesInside) {
  const Bracket bracket{2, 6};
  EXPECT_EQ(bracket.inside(3), 3);
  for (const double guess : {1.0, 2.0, 6.0, 9.0, std::nan("")}) EXPECT_EQ(bracket.inside(guess), 4);
}

TEST(Bracket, TellsHowFarItsEndsAreApartWhereTheyArePositive) {
  EXPECT_TRUE((Bracket{100, 101}).is_within(1.02));
  EXPECT_FALSE((Bracket{100, 103}).is_within(1.02));
  EXPECT_FALSE((Bracket{-1, 1}).is_within(1e9));
}

TEST(Bracket, HalvedClosesOnTheRoot) {
  Bracket bracket{0, 2};
  while (!bracket.is_within(1 + 1e-12)) {
    const double middle = bracket.middle();
    bracket.note(middle, middle * middle > 2);
  }
  EXPECT_NEAR(bracket.middle(), std::sqrt(2.0), 1e-11);
}

}  // namespace
}  // namespace beltrami
