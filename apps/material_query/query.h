#pragma once

#include <string>

namespace atrium::material_query {

/// Answers a JSON array of queries about the material model, one by one and in order. What each
/// kind takes and gives: docs/material_tool.md, or kinds_as_markdown().
///
///     answer_queries(R"([{"kind": "norm", "inputs": {"c": 0}}])")
///     == "[\n{\"kind\": \"norm\", \"values\": {\"N\": 0.3183098861837907}}\n]\n"
///
/// A query that cannot be answered gets {"kind": ..., "error": ...}. Numbers are written with the
/// digits that read back as the same double; infinite ones as "inf" and "-inf"; none is NaN.
/// Time and memory are linear in the length of the array.
/// \throws Error  with line and column, if the text is no JSON array.
[[nodiscard]] std::string answer_queries(std::string json);

/// All kinds with inputs, valid ranges and values: a Markdown table, or a JSON array.
[[nodiscard]] std::string kinds_as_markdown();
[[nodiscard]] std::string kinds_as_json();

}  // namespace atrium::material_query
