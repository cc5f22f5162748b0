#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

// Values of the command line that several programs take. All but numbers() throw Error, one line
// with the text and what is valid.
namespace atrium::app {

/// Finite numbers between separators; the whole text must be used up.
template <std::size_t N>
[[nodiscard]] std::optional<std::array<double, N>> numbers(const std::string& text,
                                                           char separator) {
  std::array<double, N> result{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = i + 1 < N ? text.find(separator, at) : text.size();
    if (end == std::string::npos || end == at) return std::nullopt;
    const std::string part = text.substr(at, end - at);
    std::size_t used = 0;
    try {
      result[i] = std::stod(part, &used);
    } catch (const std::exception&) {
      return std::nullopt;
    }
    if (used != part.size() || !std::isfinite(result[i])) return std::nullopt;
    at = end + 1;
  }
  return result;
}

/// WIDTHxHEIGHT in pixels, of --size.
[[nodiscard]] std::array<int, 2> parse_size(const std::string& text);
/// An exposure value, of --exposure; nullopt: auto.
[[nodiscard]] std::optional<double> parse_exposure(const std::string& text);
/// NAME=FACTOR, a factor of at least 0.
[[nodiscard]] std::pair<std::string, double> parse_factor(const std::string& option,
                                                          const std::string& text);

}  // namespace atrium::app
