#include "sensor_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/json.h"

namespace atrium::app {

using radiosity::Reading;
using radiosity::Sensor;

SensorSummary summarise(std::span<const Reading> readings) {
  SensorSummary s;
  s.minimum = std::numeric_limits<double>::infinity();
  double variance = 0.0;
  for (const Reading& r : readings) {
    if (!r.valid) {
      ++s.invalid;
      continue;
    }
    ++s.count;
    s.mean += r.total.y;
    s.minimum = std::min(s.minimum, r.total.y);
    s.maximum = std::max(s.maximum, r.total.y);
    variance += r.total.standard_error * r.total.standard_error;
  }
  if (s.count == 0) return {.count = 0, .invalid = s.invalid};
  const auto n = static_cast<double>(s.count);
  s.mean /= n;
  s.standard_error = std::sqrt(variance) / n;
  if (s.mean > 0.0) s.u0 = s.minimum / s.mean;
  if (s.maximum > 0.0) s.u1 = s.minimum / s.maximum;
  return s;
}

std::string describe(const SensorSummary& s, const std::string& unit) {
  if (s.count == 0) return "no sensor could be measured";
  char text[256];
  std::snprintf(text, sizeof text,
                "%zu sensors: min %.6g, mean %.6g (standard error %.2g), max %.6g %s; U0 = "
                "min/mean %.3f, U1 = min/max %.3f",
                s.count, s.minimum, s.mean, s.standard_error, s.maximum, unit.c_str(), s.u0, s.u1);
  return text +
         (s.invalid > 0 ? ", " + std::to_string(s.invalid) + " not measured" : std::string());
}

std::string sensor_csv(std::span<const Sensor> sensors, std::span<const Reading> readings,
                       const std::string& unit) {
  std::string out = "x,y,z,nx,ny,nz";
  for (const char* name : {"E", "direct", "caustic", "indirect", "standard_error"})
    out += std::string(",") + name + " [" + unit + "]";
  out += "\n";
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Vec3d &p = sensors[i].position, &n = sensors[i].normal;
    const Reading& r = readings[i];
    for (const double x : {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()}) {
      append_json_number(out, x);
      out += ',';
    }
    if (!r.valid) {
      out += ",,,,\n";
      continue;
    }
    for (const double x : {r.total.y, r.direct.y, r.caustic.y, r.indirect.y}) {
      append_json_number(out, x);
      out += ',';
    }
    append_json_number(out, r.total.standard_error);
    out += '\n';
  }
  return out;
}

namespace {

void add_vector(JsonWriter& json, const char* name, const Vec3d& v) {
  json.begin_array(name);
  for (int i = 0; i < 3; ++i) json.element(v[i]);
  json.end();
}

void add_summary(JsonWriter& json, const SensorSummary& s) {
  json.begin_object("summary");
  json.member("sensors", static_cast<std::uint64_t>(s.count));
  json.member("not_measured", static_cast<std::uint64_t>(s.invalid));
  const auto member = [&](const char* name, double value) {
    s.count > 0 ? json.member(name, value) : json.null(name);
  };
  member("minimum", s.minimum);
  member("mean", s.mean);
  member("standard_error", s.standard_error);
  member("maximum", s.maximum);
  member("U0", s.u0);
  member("U1", s.u1);
  json.end();
}

}  // namespace

std::string sensor_json(std::span<const Sensor> sensors, std::span<const Reading> readings,
                        const std::string& unit, const std::string& command) {
  JsonWriter json;
  json.begin_object();
  json.member("version", ATRIUM_VERSION);
  json.member("command", command);
  json.member("unit", unit);
  add_summary(json, summarise(readings));
  json.begin_array("sensors");
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Reading& r = readings[i];
    json.begin_object();
    add_vector(json, "position", sensors[i].position);
    add_vector(json, "normal", sensors[i].normal);
    json.member("valid", r.valid);
    if (r.valid) {
      json.member("on_surface", r.on_surface);
      json.member("E", r.total.y);
      json.member("direct", r.direct.y);
      json.member("caustic", r.caustic.y);
      json.member("indirect", r.indirect.y);
      json.member("standard_error", r.total.standard_error);
    }
    json.end();
  }
  json.end();
  json.end();
  return json.text();
}

}  // namespace atrium::app
