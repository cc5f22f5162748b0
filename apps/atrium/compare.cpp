#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "commands.h"
#include "common/json.h"
#include "material/error.h"
#include "scene/image_io.h"
#include "scene/output_file.h"
#include "trace/compare.h"
#include "trace/fireflies.h"

namespace atrium::app {

namespace {

void check_channels(const scene::Image& image, const std::string& file) {
  for (const char* name : {"R", "G", "B"}) {
    if (image.channel_index(name) < 0) throw Error(file + ": has no channel " + name);
  }
}

void print_measure(const char* name, const trace::Measure& m, double noise, bool noise_known) {
  std::printf("%-12s %8.3f %%   95 %% interval %.3f to %.3f %%", name, 100.0 * m.value,
              100.0 * m.low, 100.0 * m.high);
  if (noise_known) std::printf("   noise of the reference %.3f %% subtracted", 100.0 * noise);
  std::printf("\n");
}

void print_text(const trace::Comparison& r, std::uint64_t fireflies) {
  print_measure("RMS, pixel", r.pixel, r.pixel_noise, r.noise_known);
  print_measure("RMS, block", r.block, r.block_noise, r.noise_known);
  std::printf("%-12s %+8.3f %%", "bias", 100.0 * r.bias);
  if (r.bias_error > 0.0) std::printf("   standard error %.3f %%", 100.0 * r.bias_error);
  std::printf("\n%-12s %8.3f %%\n", "maximum", 100.0 * r.max_abs);
  std::printf("%-12s %8llu pixels\n", "fireflies", static_cast<unsigned long long>(fireflies));
  for (const trace::TermComparison& t : r.terms)
    std::printf("%-12s %8.3f %% of the light, difference %+.3f %%\n", t.name.c_str(),
                100.0 * t.share, 100.0 * t.difference);
  for (const trace::ClassComparison& t : r.classes)
    std::printf("%-12s %8.3f %% of the light, difference %+.3f +- %.3f %%, RMS %.3f %%\n",
                t.name.c_str(), 100.0 * t.share, 100.0 * t.difference, 100.0 * t.interval,
                100.0 * t.rms);
  if (!r.noise_known) std::printf("the reference has no stderr.* layers: its noise is included\n");
  if (r.pixels_skipped > 0)
    std::printf("%zu pixels are not finite and were skipped\n", r.pixels_skipped);
}

void add_measure(JsonWriter& json, const char* name, const trace::Measure& m, double noise) {
  json.begin_object(name);
  json.member("value", m.value);
  json.member("low", m.low);
  json.member("high", m.high);
  json.member("reference_noise", noise);
  json.end();
}

void print_json(const trace::Comparison& r, std::uint64_t fireflies) {
  JsonWriter json;
  json.begin_object();
  add_measure(json, "pixel", r.pixel, r.pixel_noise);
  add_measure(json, "block", r.block, r.block_noise);
  json.member("bias", r.bias);
  json.member("bias_standard_error", r.bias_error);
  json.member("max", r.max_abs);
  json.member("fireflies", fireflies);
  json.begin_object("terms");
  for (const trace::TermComparison& t : r.terms) {
    json.begin_object(t.name.c_str());
    json.member("share", t.share);
    json.member("difference", t.difference);
    json.end();
  }
  json.end();
  json.begin_object("classes");
  for (const trace::ClassComparison& t : r.classes) {
    json.begin_object(t.name.c_str());
    json.member("share", t.share);
    json.member("difference", t.difference);
    json.member("interval", t.interval);
    json.member("rms", t.rms);
    json.end();
  }
  json.end();
  json.member("noise_known", r.noise_known);
  json.member("pixels", static_cast<std::uint64_t>(r.pixels));
  json.member("pixels_skipped", static_cast<std::uint64_t>(r.pixels_skipped));
  json.end();
  std::fputs(json.text().c_str(), stdout);
}

}  // namespace

int run_compare(const CompareCommand& c) {
  if (!c.difference.empty()) {
    if (!scene::is_image_ending(c.difference)) {
      throw Error(c.difference + ": unknown image format (known: .exr .pfm .png .jpg)");
    }
    if (scene::file_ending(c.difference) == ".hdr") {
      throw Error(c.difference +
                  ": .hdr cannot hold a difference, which has a sign (.exr .pfm can)");
    }
    scene::check_output(c.difference);
  }
  const scene::Image image = scene::read_image(c.image);
  const scene::Image reference = scene::read_image(c.reference);
  check_channels(image, c.image);
  check_channels(reference, c.reference);
  if (image.width != reference.width || image.height != reference.height) {
    throw Error(c.image + ": has " + std::to_string(image.width) + "x" +
                std::to_string(image.height) + " pixels, " + c.reference + " has " +
                std::to_string(reference.width) + "x" + std::to_string(reference.height));
  }
  const trace::Comparison result = trace::compare(image, reference);
  const std::uint64_t fireflies = trace::count_fireflies(image, reference);
  c.json ? print_json(result, fireflies) : print_text(result, fireflies);
  if (!c.difference.empty()) {
    const scene::Image difference = trace::difference_image(image, reference);
    scene::write_image(scene::is_display_ending(c.difference)
                           ? trace::show_difference(difference, c.full_scale)
                           : difference,
                       c.difference);
  }
  return 0;
}

}  // namespace atrium::app
