#include <exception>

#include "common/json.h"
#include "common/suggest.h"
#include "material/error.h"
#include "material_query/json_value.h"
#include "material_query/kinds.h"
#include "material_query/query.h"

namespace atrium::material_query {
namespace {

const Kind* find_kind(std::string_view name) {
  for (const Kind& kind : all_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::vector<std::string_view> kind_names() {
  std::vector<std::string_view> names;
  for (const Kind& kind : all_kinds()) names.push_back(kind.name);
  return names;
}

/// A query taken apart: exactly the members `kind` and `inputs`.
struct Query {
  const JsonValue* kind = nullptr;
  const JsonValue* inputs = nullptr;
  std::string error;  ///< what is wrong with it
};

Query take_apart(const JsonValue& value) {
  Query q;
  if (value.type != JsonValue::Type::Object || value.too_deep) {
    q.error = "query is " + describe(value) + ", must be an object {kind, inputs}";
    return q;
  }
  for (std::size_t i = 0; i < value.keys.size(); ++i) {
    const bool kind = value.keys[i] == "kind";
    if (!kind && value.keys[i] != "inputs") {
      q.error = "unknown member '" + value.keys[i] + "' of a query (known: kind inputs)";
      continue;
    }
    const JsonValue*& member = kind ? q.kind : q.inputs;
    if (member) q.error = "member '" + value.keys[i] + "' of the query is given twice";
    member = &value.items[i];
  }
  if (!q.error.empty()) return q;
  if (!q.kind || q.kind->type != JsonValue::Type::Text)
    q.error =
        q.kind ? "kind is " + describe(*q.kind) + ", must be a text" : "missing member 'kind'";
  else if (!q.inputs || q.inputs->type != JsonValue::Type::Object || q.inputs->too_deep)
    q.error = q.inputs ? "inputs is " + describe(*q.inputs) + ", must be an object"
                       : "missing member 'inputs'";
  return q;
}

void append_values(std::string& out, const Query& q) {
  const Kind* kind = find_kind(q.kind->text);
  if (!kind)
    throw Error("unknown kind '" + q.kind->text + "'" +
                app::suggestion(q.kind->text, kind_names()));
  const Inputs inputs(kind->inputs, *q.inputs);
  out += "\"values\": {";
  Answer answer(out);
  kind->answer(inputs, answer);
  out += '}';
}

void append_answer(std::string& out, const JsonValue& value) {
  const Query q = take_apart(value);
  out += "{\"kind\": ";
  if (q.kind && q.kind->type == JsonValue::Type::Text)
    app::append_json_text(out, q.kind->text);
  else
    out += "null";
  out += ", ";
  const std::size_t begin = out.size();
  std::string error = q.error;
  if (error.empty()) {
    try {
      append_values(out, q);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& e) {  // of this query: Error, std::invalid_argument, no number
      out.resize(begin);
      error = e.what();
    }
  }
  if (!error.empty()) {
    out += "\"error\": ";
    app::append_json_text(out, error);
  }
  out += '}';
}

}  // namespace

std::string answer_queries(std::string json) {
  std::string out = "[";
  read_array(std::move(json), [&](JsonValue&& value) {
    out += out.size() == 1 ? "\n" : ",\n";
    append_answer(out, value);
  });
  return out + "\n]\n";
}

void Answer::key(std::string_view name) {
  if (!first_) out_ += ", ";
  first_ = false;
  app::append_json_text(out_, name);
  out_ += ": ";
}

void Answer::append(std::string_view name, double value, bool infinite) {
  if (std::isnan(value) || (std::isinf(value) && !infinite))
    throw std::runtime_error(std::string(name) +
                             " has no finite value in double precision for these inputs");
  if (std::isinf(value))
    out_ += value > 0.0 ? "\"inf\"" : "\"-inf\"";
  else
    app::append_json_number(out_, value);
}

void Answer::number(std::string_view name, double value) {
  key(name);
  append(name, value, false);
}

void Answer::number_or_infinite(std::string_view name, double value) {
  key(name);
  append(name, value, true);
}

void Answer::numbers(std::string_view name, const std::vector<double>& values) {
  key(name);
  out_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out_ += ", ";
    append(name, values[i], false);
  }
  out_ += ']';
}

void Answer::flag(std::string_view name, bool value) {
  key(name);
  out_ += value ? "true" : "false";
}

void Answer::text(std::string_view name, std::string_view value) {
  key(name);
  app::append_json_text(out_, value);
}

}  // namespace atrium::material_query
