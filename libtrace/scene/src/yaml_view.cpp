#include "yaml_view.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "material/error.h"

namespace atrium::scene {
namespace {

std::string listed(std::initializer_list<std::string_view> words) {
  std::string list;
  for (const std::string_view word : words) list += (list.empty() ? "" : ", ") + std::string(word);
  return list;
}

// YAML's .inf and .nan, "1e999" and "0x10" are no numbers here; a leading plus is.
std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::string in_words(double value) {
  std::string text(32, '\0');
  const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), value);
  text.resize(static_cast<std::size_t>(end - text.data()));
  return code == std::errc() ? text : "?";
}

}  // namespace

std::string YamlView::place() const {
  return *file_ + ":" + std::to_string(node_->line) + ":" + std::to_string(node_->column);
}

void YamlView::fail(const std::string& message) const { throw Error(place() + ": " + message); }

bool YamlView::is_number() const {
  return node_->kind == YamlNode::Kind::Scalar && parse_number(node_->text).has_value();
}

std::string YamlView::text() const {
  if (node_->kind != YamlNode::Kind::Scalar || node_->text.empty()) fail("expected a word");
  return node_->text;
}

bool YamlView::boolean() const { return choice({"false", "true"}) == 1; }

double YamlView::number(double low, double high) const {
  if (node_->kind != YamlNode::Kind::Scalar) fail("expected a number");
  const std::optional<double> value = parse_number(node_->text);
  if (!value) fail("expected a finite number, found '" + node_->text + "'");
  if (*value >= low && *value <= high) return *value;
  constexpr double open = std::numeric_limits<double>::max();
  if (high == open) fail("must be " + in_words(low) + " or more, is " + node_->text);
  fail("must lie within " + in_words(low) + " and " + in_words(high) + ", is " + node_->text);
}

double YamlView::positive() const {
  const double value = number();
  if (!(value > 0.0)) fail("must be greater than 0, is " + node_->text);
  return value;
}

int YamlView::integer(int low, int high) const {
  const double value = number(low, high);
  if (value != std::floor(value)) fail("expected a whole number, found '" + node_->text + "'");
  return static_cast<int>(value);
}

std::vector<YamlView> YamlView::items() const {
  if (!is_sequence()) fail("expected a list");
  std::vector<YamlView> views;
  for (const YamlNode& item : node_->items) views.emplace_back(item, *file_);
  return views;
}

std::vector<double> YamlView::numbers(std::size_t count) const {
  if (!is_sequence() || node_->items.size() != count) {
    fail("expected a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (const YamlView& item : items()) values.push_back(item.number());
  return values;
}

Vec3d YamlView::vector() const {
  const std::vector<double> v = numbers(3);
  return {v[0], v[1], v[2]};
}

Vec3d YamlView::direction() const {
  const Vec3d v = vector();
  const double length = v.stableNorm();
  if (!(length > 0.0)) fail("a direction must not be zero");
  return v / length;
}

std::size_t YamlView::choice(std::initializer_list<std::string_view> words) const {
  const std::string word = node_->kind == YamlNode::Kind::Scalar ? node_->text : "";
  const auto* found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) fail("expected one of: " + listed(words));
  return static_cast<std::size_t>(found - words.begin());
}

YamlMap YamlView::map(std::string_view what, std::initializer_list<std::string_view> known) const {
  const std::string name(what);
  if (!is_map()) fail(name + " must be a map with keys among: " + listed(known));
  for (const YamlNode::Entry& entry : node_->entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    YamlNode key;
    key.line = entry.line;
    key.column = entry.column;
    YamlView(key, *file_)
        .fail("unknown key '" + entry.key + "' in " + name + "; known keys: " + listed(known));
  }
  return YamlMap(*this, name);
}

std::vector<std::pair<std::string, YamlView>> YamlView::named() const {
  if (!is_map()) fail("expected a map of names");
  std::vector<std::pair<std::string, YamlView>> result;
  for (const YamlNode::Entry& entry : node_->entries) {
    result.emplace_back(entry.key, YamlView(entry.value, *file_));
  }
  return result;
}

std::filesystem::path YamlView::file() const {
  const std::filesystem::path relative(text());
  const bool climbs = std::any_of(relative.begin(), relative.end(),
                                  [](const std::filesystem::path& part) { return part == ".."; });
  if (relative.is_absolute() || relative.has_root_path() || climbs) {
    fail("a file must lie beside the scene or below it (relative path without '..')");
  }
  std::filesystem::path path = std::filesystem::path(*file_).parent_path() / relative;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail("no file '" + relative.string() + "'");
  return path;
}

std::optional<YamlView> YamlMap::find(std::string_view key) const {
  for (const YamlNode::Entry& entry : view_.node_->entries) {
    if (entry.key == key) return YamlView(entry.value, *view_.file_);
  }
  return std::nullopt;
}

YamlView YamlMap::get(std::string_view key) const {
  const std::optional<YamlView> value = find(key);
  if (!value) view_.fail(what_ + " needs '" + std::string(key) + "'");
  return *value;
}

std::string YamlMap::one_of(std::initializer_list<std::string_view> keys) const {
  std::string found;
  for (const std::string_view key : keys) {
    if (!has(key)) continue;
    if (!found.empty()) view_.fail(what_ + " takes only one of: " + listed(keys));
    found = key;
  }
  if (found.empty()) view_.fail(what_ + " needs one of: " + listed(keys));
  return found;
}

}  // namespace atrium::scene
