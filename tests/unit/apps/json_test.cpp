#include "common/json.h"

#include <limits>

#include <gtest/gtest.h>

namespace {

using atrium::app::JsonWriter;

TEST(JsonWriter, NestsAndSeparates) {
  JsonWriter json;
  json.begin_object();
  json.member("a", 1);
  json.begin_array("list");
  json.element("x");
  json.element(0.5);
  json.end();
  json.begin_object("empty");
  json.end();
  json.member("yes", true);
  json.end();
  EXPECT_EQ(
      json.text(),
      "{\n  \"a\": 1,\n  \"list\": [\n    \"x\",\n    0.5\n  ],\n  \"empty\": {},\n  \"yes\": "
      "true\n}\n");
}

TEST(JsonWriter, EscapesTextAndHasNoInfinity) {
  JsonWriter json;
  json.begin_object();
  json.member("q\"\\\n", "\x01 ü");
  json.member("inf", std::numeric_limits<double>::infinity());
  json.member("tenth", 0.1);
  json.end();
  EXPECT_EQ(json.text(),
            "{\n  \"q\\\"\\\\\\u000a\": \"\\u0001 ü\",\n  \"inf\": null,\n  \"tenth\": 0.1\n}\n");
}

}  // namespace
