#pragma once

#include <string>
#include <vector>

#include "plot/plot.h"

namespace atrium::plot {

/// Version of this interface and of plot.h; a module of another build is refused.
inline constexpr int kPlotInterface = 1;

enum class Format { Svg, Png };

/// What the plot module offers. Nothing is thrown across its border: the result is what went
/// wrong, "" if nothing did. The arguments have been checked.
class PlotModule {
 public:
  virtual ~PlotModule() = default;
  virtual std::string write(const std::vector<Panel>& panels, const Picture& picture, Format format,
                            const std::string& file) const = 0;
};

/// Entry point `atrium_plot`: nullptr if the interface version is another.
using PlotEntry = const PlotModule* (*)(int interface_version);

}  // namespace atrium::plot
