#include "common/option_values.h"

#include "material/error.h"

namespace atrium::app {

std::array<int, 2> parse_size(const std::string& text) {
  const auto n = numbers<2>(text, 'x');
  const auto fits = [](double v) { return v >= 1.0 && v <= 65536.0 && v == std::floor(v); };
  if (!n || !fits((*n)[0]) || !fits((*n)[1])) {
    throw Error("--size " + text + ": is not WIDTHxHEIGHT in pixels, 1 to 65536 each");
  }
  return {static_cast<int>((*n)[0]), static_cast<int>((*n)[1])};
}

std::optional<double> parse_exposure(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const auto n = numbers<1>(text, ' ');
  if (!n || !(std::abs((*n)[0]) <= 60.0)) {
    throw Error("--exposure " + text + ": is neither auto nor an exposure value (-60 to 60)");
  }
  return (*n)[0];
}

std::pair<std::string, double> parse_factor(const std::string& option, const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const auto n =
      equals == std::string::npos ? std::nullopt : numbers<1>(text.substr(equals + 1), ' ');
  if (!n || equals == 0 || !((*n)[0] >= 0.0))
    throw Error(option + " " + text + ": is not NAME=FACTOR with a factor of at least 0");
  return {text.substr(0, equals), (*n)[0]};
}

}  // namespace atrium::app
