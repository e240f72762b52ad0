// The operations of catalog/vocabulary.inl for float and double, so that formula files serve scalar code and tests too. pow_,
// highlight_pow_ and fast_pow_ are left to the user: which ones is part of the contract.
#pragma once
#include <cmath>

#include "catalog/catalog.h"
#include "scene/scene_data.h"

namespace spanray::scalar {

template <class T> T number(float x) { return static_cast<T>(x); }
template <class T> T select(bool m, T yes, T no) { return m ? yes : no; }
template <class T> T min_(T a, T b) { return a < b ? a : b; }
template <class T> T max_(T a, T b) { return a > b ? a : b; }
template <class T> T sqrt_(T a) { return std::sqrt(a); }
template <class T> T mul_add(T a, T b, T c) { return std::fma(a, b, c); }

}  // namespace spanray::scalar
