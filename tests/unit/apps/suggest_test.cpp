#include "common/suggest.h"

#include <gtest/gtest.h>

namespace {

using atrium::app::nearest_name;

TEST(Suggest, FindsMistypedNamesAndNothingElse) {
  const std::vector<std::string_view> known = {"gold", "silver", "c", "fresnel_mean"};
  EXPECT_EQ(nearest_name("golt", known), "gold");
  EXPECT_EQ(nearest_name("GOLD", known), "gold");
  EXPECT_EQ(nearest_name("glod", known), "gold");  // a swap is one mistake
  EXPECT_EQ(nearest_name("slver", known), "silver");
  EXPECT_EQ(nearest_name("fresnel_maen", known), "fresnel_mean");
  EXPECT_EQ(nearest_name("x", known), "");  // not "c": that would be all letters changed
  EXPECT_EQ(nearest_name("copper", known), "");
  EXPECT_EQ(nearest_name("", known), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'g'), known), "");
  EXPECT_EQ(atrium::app::suggestion("golt", {"gold", "silver"}),
            " (did you mean gold? known: gold silver)");
}

}  // namespace
