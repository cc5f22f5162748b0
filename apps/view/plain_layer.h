#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <vtkSmartPointer.h>

#include "picker.h"
#include "plain_things.h"

class vtkActor;
class vtkPolyData;
class vtkPolyDataMapper;
class vtkRenderer;

namespace atrium::view {

/// Things without elements in a renderer: lamps shine, metals are grey, glass is a little tinted.
class PlainLayer {
 public:
  explicit PlainLayer(vtkRenderer& renderer);

  struct Shown {
    /// Exposure of true colours. Absent: colours mean values, so lamps are white and of glass only
    /// the edges are there, which change no colour behind it.
    std::optional<double> ev;
    std::vector<double> factors;       ///< of light groups; other than there are: all 1
    std::vector<std::uint8_t> hidden;  ///< by thing
  };
  void show(const PlainThings& things, const Shown& shown);
  void clip(const std::vector<Clip>& clips);
  void clear();

 private:
  enum Part : std::size_t { Lamps, OneSidedLamps, Metals, Glass, GlassEdges, kParts };
  struct Layer {
    vtkSmartPointer<vtkPolyDataMapper> mapper;
    vtkSmartPointer<vtkActor> actor;
  };
  void set(Part part, vtkPolyData& data);

  std::array<Layer, kParts> layers_;
};

}  // namespace atrium::view
