#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace atrium::app {

/// Adds a text in quotes, escaped.
void append_json_text(std::string& out, std::string_view value);
/// Adds the shortest digits that read back as the same number. Not for NaN or infinity.
void append_json_number(std::string& out, double value);

/// Writes JSON with members in the order given. Text is escaped; numbers that are not finite
/// become null, as JSON has none.
///
///     JsonWriter json;
///     json.begin_object();
///     json.member("version", "0.1.0");
///     json.begin_object("phases"); ... json.end();
///     json.end();
///     json.text();
class JsonWriter {
 public:
  void begin_object(std::string_view name = {}) { begin(name, '{'); }
  void begin_array(std::string_view name = {}) { begin(name, '['); }
  void end();
  void member(std::string_view name, std::string_view value);
  void member(std::string_view name, const char* value) { member(name, std::string_view(value)); }
  void member(std::string_view name, double value);
  void member(std::string_view name, bool value);
  void member(std::string_view name, std::uint64_t value);
  void member(std::string_view name, int value);
  void null(std::string_view name);
  void element(std::string_view value) { member({}, value); }
  void element(double value) { member({}, value); }

  /// Everything so far, with a line end.
  [[nodiscard]] std::string text() const { return out_ + "\n"; }

 private:
  void begin(std::string_view name, char bracket);
  void key(std::string_view name);
  std::string out_;
  std::vector<char> open_;
  bool first_ = true;
};

}  // namespace atrium::app
