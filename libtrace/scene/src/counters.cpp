#include "scene/counters.h"

namespace atrium::scene {

std::string_view counter_name(Counter counter) {
  switch (counter) {
    case Counter::RaysPrimary:
      return "rays.primary";
    case Counter::RaysShadow:
      return "rays.shadow";
    case Counter::RaysGather:
      return "rays.gather";
    case Counter::RaysSpecular:
      return "rays.specular";
    case Counter::RaysPath:
      return "rays.path";
    case Counter::RaysRow:
      return "rays.row";
    case Counter::RaysDirect:
      return "rays.direct";
    case Counter::RaysPhoton:
      return "rays.photon";
    case Counter::RaysProbe:
      return "rays.probe";
    case Counter::RaysRefused:
      return "rays.refused";
    case Counter::SamplesDropped:
      return "samples.dropped";
    case Counter::Samples:
      return "samples";
    case Counter::Elements:
      return "elements";
    case Counter::ElementSides:
      return "element_sides";
    case Counter::RowEntries:
      return "row_entries";
    case Counter::Iterations:
      return "iterations";
    case Counter::Count_:
      break;
  }
  return "";
}

std::uint64_t Counters::rays() const {
  std::uint64_t sum = 0;
  for (auto c = Counter::RaysPrimary; c <= Counter::RaysProbe;
       c = static_cast<Counter>(static_cast<int>(c) + 1))
    sum += (*this)[c];
  return sum;
}

}  // namespace atrium::scene
