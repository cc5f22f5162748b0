#include "frame_names.h"

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>

#include "material/error.h"

namespace atrium::app {
namespace {

constexpr int kDigits = 4;
constexpr int kMostDigits = 9;

/// Where the number goes in a name, and how wide it is at least.
struct Conversion {
  std::size_t begin = 0, end = 0;
  int digits = 1;
};

/// The first %d or %0Nd from a place on; nullopt: there is none or it is another conversion.
std::optional<Conversion> conversion_at(const std::string& name, std::size_t percent) {
  std::size_t at = percent + 1;
  Conversion c{percent, 0, 1};
  if (at < name.size() && name[at] == '0') {
    const auto [end, error] =
        std::from_chars(name.data() + at + 1, name.data() + name.size(), c.digits);
    if (error != std::errc() || c.digits < 1 || c.digits > kMostDigits) return std::nullopt;
    at = static_cast<std::size_t>(end - name.data());
  }
  if (at >= name.size() || name[at] != 'd') return std::nullopt;
  c.end = at + 1;
  return c;
}

std::string padded(int number, int digits) {
  char text[24];
  std::snprintf(text, sizeof text, "%0*d", digits, number);
  return text;
}

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void check_frame_pattern(const std::string& output) {
  const std::size_t percent = output.find('%');
  if (percent == std::string::npos) return;
  const auto c = conversion_at(output, percent);
  if (!c || output.find('%', c->end) != std::string::npos)
    throw Error(output + ": the number of a frame is one %d or %0Nd, as in walk-%04d.png");
}

std::string frame_name(const std::string& output, int frame) {
  const std::size_t percent = output.find('%');
  if (percent != std::string::npos) {
    const Conversion c = conversion_at(output, percent).value();
    return output.substr(0, c.begin) + padded(frame, c.digits) + output.substr(c.end);
  }
  const std::filesystem::path path(output);
  const std::string name =
      path.stem().string() + "-" + padded(frame, kDigits) + path.extension().string();
  return (path.parent_path() / name).string();
}

std::array<int, 2> parse_frame_range(const std::string& text, int frames) {
  const auto fail = [&]() {
    throw Error("--frame-range " + text + ": expected A-B, A, A- or -B within 1-" +
                std::to_string(frames));
  };
  const std::size_t dash = text.find('-');
  const std::string first = text.substr(0, dash);
  const std::string last = dash == std::string::npos ? first : text.substr(dash + 1);
  if (first.empty() && last.empty()) fail();
  const auto a = first.empty() ? std::optional(1) : whole_number(first);
  const auto b = last.empty() ? std::optional(frames) : whole_number(last);
  if (!a || !b || *a < 1 || *b < *a || *b > frames) fail();
  return {*a, *b};
}

}  // namespace atrium::app
