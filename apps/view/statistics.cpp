#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/json.h"

namespace atrium::view {
namespace {

double median_of(std::vector<Weighted> known, double area) {
  std::sort(known.begin(), known.end(),
            [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
  double sum = 0.0;
  for (const Weighted& w : known)
    if ((sum += w.area) >= 0.5 * area) return w.value;
  return known.empty() ? 0.0 : known.back().value;
}

std::string format(const char* text, double a, double b) {
  char line[96];
  std::snprintf(line, sizeof line, text, a, b);
  return line;
}

}  // namespace

Statistics make_statistics(const std::vector<Weighted>& values, int bins) {
  Statistics s;
  std::vector<Weighted> known;
  double sum = 0.0;
  for (const Weighted& w : values) {
    if (!std::isfinite(w.value)) {
      s.unknown_area += w.area;
      continue;
    }
    s.minimum = known.empty() ? w.value : std::min(s.minimum, w.value);
    s.maximum = known.empty() ? w.value : std::max(s.maximum, w.value);
    s.area += w.area;
    sum += w.area * w.value;
    known.push_back(w);
  }
  s.polygons = known.size();
  s.mean = s.area > 0.0 ? sum / s.area : 0.0;
  s.u0 = s.mean > 0.0 ? s.minimum / s.mean : 0.0;
  s.ud = s.maximum > 0.0 ? s.minimum / s.maximum : 0.0;
  s.range = {s.minimum, s.maximum > s.minimum ? s.maximum : s.minimum + 1.0, false};
  s.histogram.assign(static_cast<std::size_t>(bins), 0.0);
  for (const Weighted& w : known) {
    const auto bin = static_cast<std::size_t>(s.range.position(w.value) * bins);
    s.histogram[std::min(bin, s.histogram.size() - 1)] += w.area;
  }
  s.median = median_of(std::move(known), s.area);
  return s;
}

std::string to_json(const Statistics& s, const std::string& field, const std::string& selection) {
  app::JsonWriter json;
  json.begin_object();
  json.member("field", field);
  json.member("selection", selection);
  json.member("polygons", static_cast<std::uint64_t>(s.polygons));
  json.member("area", s.area);
  json.member("unknown_area", s.unknown_area);
  for (const auto& [name, value] :
       {std::pair("mean", s.mean), std::pair("median", s.median), std::pair("minimum", s.minimum),
        std::pair("maximum", s.maximum), std::pair("u0", s.u0), std::pair("ud", s.ud)})
    if (s.polygons > 0)
      json.member(name, value);
    else
      json.null(name);
  json.begin_array("histogram");
  for (const double a : s.histogram) json.element(a);
  json.end();
  json.end();
  return json.text();
}

std::string to_text(const Statistics& s, const std::string& title, const std::string& selection) {
  std::string text = title + " of " + selection + ", by elements\n";
  if (s.polygons == 0) return text + "nothing known\n";
  text += format("mean %.4g, median %.4g\n", s.mean, s.median);
  text += format("least %.4g, most %.4g\n", s.minimum, s.maximum);
  text += format("U0 = least/mean %.3f, Ud = least/most %.3f\n", s.u0, s.ud);
  text += format("area %.4g m^2, unknown %.4g m^2\n", s.area, s.unknown_area);
  return text;
}

}  // namespace atrium::view
