// FLIP: how different two pictures look to somebody who flips between them.
// Source: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM
//         on Computer Graphics and Interactive Techniques 3(2): the measure for low dynamic range. Sections of the paper stand at each step.
#pragma once
#include <vector>

#include "core/parallel.h"
#include "image/picture_view.h"

namespace spanray {

// A 4K monitor 0.7 m wide, seen from 0.7 m (4.3 there): 67 pixels a degree.
inline constexpr double kFlipPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

// One value a pixel, row-major, in [0, 1]: 0 equal, 1 the greatest difference there is (pure green against pure blue).
// Input:    pictures of one size, consistent, finite; values are held in [0, 1]. Beyond the border, the nearest pixel stands.
// Contract: symmetric in a and b; the same for any number of threads.
std::vector<float> flip_map(const PictureView& a, const PictureView& b, Parallel& parallel,
                            double pixels_per_degree = kFlipPixelsPerDegree);

// The steps, for tests.
namespace flip {

// Weights from -radius to radius; with sum 1, where not said otherwise.
struct Kernel {
  int radius = 0;
  std::vector<double> weight;
  double at(int i) const { return weight[static_cast<size_t>(i + radius)]; }
};
// Contrast sensitivity (4.1.1) as a sum of separable Gaussians: share[i] times kernel[i] along x and along y. Shares have the sum 1.
struct Sensitivity { int terms = 1; double share[2] = {1, 0}; Kernel kernel[2]; };
enum class Channel { kAchromatic, kRedGreen, kBlueYellow };
Sensitivity contrast_sensitivity(Channel channel, double pixels_per_degree);
// Feature detectors (4.2): a Gaussian, and its first and second derivative, whose positive weights have the sum 1 and the negative ones -1.
struct Features { Kernel smooth, edge, point; };
Features feature_kernels(double pixels_per_degree);

// L*a*b* with chroma scaled by 0.01 L* (4.1.2, after Hunt 1952).
Color3 hunt_lab(const Color3& linear_rgb);
// 4.1.3: the HyAB distance (Abasi et al. 2020).
double hyab(const Color3& lab1, const Color3& lab2);
// 4.1.4: a distance to the power 0.7, mapped to [0, 1] in two linear parts that meet at 0.95.
double color_error(double hyab_distance);

}  // namespace flip
}  // namespace spanray
