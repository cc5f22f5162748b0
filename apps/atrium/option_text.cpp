#include "option_text.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "material/error.h"

namespace atrium::app {

std::string shell_word(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

double parse_length(const char* option, const std::string& text) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"nm", 1e-9}, {"um", 1e-6}, {"\u00b5m", 1e-6}, {"\u03bcm", 1e-6}, {"mm", 1e-3}, {"m", 1.0}};
  std::string amount = text;
  double unit = 1.0;
  for (const auto& [name, metres] : kUnits) {
    if (!text.ends_with(name)) continue;
    amount.resize(text.size() - name.size());
    unit = metres;
    break;
  }
  const auto n = numbers<1>(amount, ' ');
  if (!n || !((*n)[0] >= 0.0))
    throw Error(std::string(option) + " " + text +
                ": is no length of at least 0, such as 0.2um, 200nm or 2e-7 (metres)");
  return (*n)[0] * unit;
}

std::vector<double> parse_wavelengths(const std::string& text) {
  constexpr double kMost = 10000.0;
  std::vector<double> list;
  if (const auto range = numbers<3>(text, ':')) {
    const auto [first, last, step] = *range;
    if (first > 0.0 && last >= first && step > 0.0 && (last - first) / step < kMost)
      for (int i = 0; first + i * step <= last * (1.0 + 1e-12); ++i)
        list.push_back(first + i * step);
  } else {
    for (std::size_t at = 0; at <= text.size();) {
      const std::size_t end = std::min(text.find(',', at), text.size());
      const auto n = numbers<1>(text.substr(at, end - at), ' ');
      if (!n || !((*n)[0] > 0.0)) {
        list.clear();
        break;
      }
      list.push_back((*n)[0]);
      at = end + 1;
    }
  }
  if (list.empty())
    throw Error("--wavelengths " + text +
                ": is neither FIRST:LAST:STEP nor a list A,B,C of wavelengths above 0 in nm");
  return list;
}

std::array<double, 4> parse_crop(const std::string& text) {
  const auto n = numbers<4>(text, ',');
  if (!n || !((*n)[0] >= 0.0 && (*n)[0] < (*n)[2] && (*n)[2] <= 1.0 && (*n)[1] >= 0.0 &&
              (*n)[1] < (*n)[3] && (*n)[3] <= 1.0)) {
    throw Error("--crop " + text +
                ": is not X0,Y0,X1,Y1 with 0 <= X0 < X1 <= 1, 0 <= Y0 < Y1 <= 1");
  }
  return *n;
}

SensorGrid parse_grid(const std::vector<std::string>& words) {
  std::string all = "--grid";
  for (const std::string& word : words) all += " " + word;
  const auto fail = [&](const std::string& why) { throw Error(all + ": " + why); };
  SensorGrid grid;
  std::array<double, 3>* const vectors[] = {&grid.origin, &grid.u, &grid.v};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto n = numbers<3>(words.at(i), ',');
    if (!n) fail(words[i] + " is not X,Y,Z in metres");
    *vectors[i] = *n;
  }
  const auto cells = numbers<2>(words.at(3), 'x');
  const auto fits = [](double v) { return v >= 1.0 && v <= 1e6 && v == std::floor(v); };
  if (!cells || !fits((*cells)[0]) || !fits((*cells)[1]) || (*cells)[0] * (*cells)[1] > 1e7)
    fail(words[3] + " is not NxM, two whole numbers of at least 1 with a product up to 1e7");
  grid.cells = {static_cast<int>((*cells)[0]), static_cast<int>((*cells)[1])};
  const auto& [a, b, c] = grid.u;
  const auto& [d, e, f] = grid.v;
  const double area = std::hypot(b * f - c * e, c * d - a * f, a * e - b * d);
  if (!(area > 1e-9 * std::hypot(a, b, c) * std::hypot(d, e, f)))
    fail("the edges span no parallelogram");
  return grid;
}

}  // namespace atrium::app
