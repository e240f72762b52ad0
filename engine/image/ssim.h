// Structural similarity.
#pragma once
#include "core/parallel.h"
#include "image/picture_view.h"

namespace spanray {

// Mean structural similarity of sRGB-encoded luma (0.299 R' + 0.587 G' + 0.114 B', 0 to 255); 1 for equal pictures.
// Source:   Wang, Bovik, Sheikh, Simoncelli 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE
//           Transactions on Image Processing 13(4): windows of 11 x 11, Gaussian of deviation 1.5, K1 = 0.01, K2 = 0.03; only windows
//           that lie in the picture.
// Input:    pictures of one size, not empty. A window is no larger than the picture.
// Contract: symmetric; the same for any number of threads.
double mean_ssim(const PictureView& a, const PictureView& b, Parallel& parallel);

}  // namespace spanray
