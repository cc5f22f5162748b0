#pragma once

#include <array>
#include <type_traits>

namespace atrium::material {

/// Positive nodes of the Gauss-Legendre rule on [-1, 1] and their weights: roots of the Legendre
/// polynomial, computed to 40 digits.
template <int Points>
struct GaussLegendre;
template <>
struct GaussLegendre<16> {
  static constexpr std::array node = {
      0.095012509837637440, 0.281603550779258913, 0.458016777657227386, 0.617876244402643748,
      0.755404408355003033, 0.865631202387831743, 0.944575023073232576, 0.989400934991649932};
  static constexpr std::array weight = {
      0.189450610455068496, 0.182603415044923588, 0.169156519395002538, 0.149595988816576732,
      0.124628971255533872, 0.095158511682492784, 0.062253523938647892, 0.027152459411754094};
};
template <>
struct GaussLegendre<32> {
  static constexpr std::array node = {
      0.0483076656877383162, 0.144471961582796493, 0.239287362252137075, 0.33186860228212765,
      0.421351276130635345,  0.50689990893222939,  0.587715757240762329, 0.663044266930215201,
      0.73218211874028968,   0.794483795967942407, 0.84936761373256997,  0.896321155766052124,
      0.934906075937739689,  0.964762255587506431, 0.985611511545268335, 0.997263861849481564};
  static constexpr std::array weight = {
      0.0965400885147278006, 0.0956387200792748594, 0.0938443990808045656, 0.0911738786957638847,
      0.0876520930044038111, 0.0833119242269467552, 0.0781938957870703065, 0.0723457941088485062,
      0.0658222227763618468, 0.0586840934785355471, 0.0509980592623761762, 0.0428358980222266807,
      0.0342738629130214331, 0.0253920653092620595, 0.0162743947309056706, 0.0070186100094700966};
};

/// Integral of f over [a, b], exact for polynomials up to degree 2 Points - 1. f gives a number or
/// an array of them (a value, not an expression).
template <int Points, class F>
[[nodiscard]] auto gauss_legendre(double a, double b, F&& f) {
  using Rule = GaussLegendre<Points>;
  using Value = std::decay_t<decltype(f(a))>;
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  const auto pair = [&](std::size_t i) -> Value {
    const double offset = half * Rule::node[i];
    return half * Rule::weight[i] * (f(middle - offset) + f(middle + offset));
  };
  Value sum = pair(0);
  for (std::size_t i = 1; i < Rule::node.size(); ++i) sum += pair(i);
  return sum;
}

template <class F>
[[nodiscard]] double gauss_legendre_32(double a, double b, F&& f) {
  return gauss_legendre<32>(a, b, f);
}

}  // namespace atrium::material
