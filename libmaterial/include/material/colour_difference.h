#pragma once

#include <Eigen/Core>

namespace atrium::material {

/// CIE 1976 L*a*b* of a stimulus, relative to a white. CIE 15:2004, Eqs. 8.3 to 8.11.
/// \param xyz    any finite tristimulus; the linear part continues below 0.
/// \param white  of the same scale, every component > 0.
[[nodiscard]] Eigen::Vector3d lab_from_xyz(const Eigen::Vector3d& xyz,
                                           const Eigen::Vector3d& white);

/// CIEDE2000 difference of two L*a*b* colours; about 1 is just noticeable. Symmetric, 0 for equal
/// colours; k_L = k_C = k_H = 1.
/// Source: G. Sharma, W. Wu, E. N. Dalal, Color Res. Appl. 30, 21 (2005), with their treatment of
/// mean hues across 0 and of greys.
[[nodiscard]] double ciede2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2);

}  // namespace atrium::material
