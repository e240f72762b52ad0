// Alpha blending: a layer over what lies behind it.
// index: 0
// Source:   Porter and Duff 1984, "Compositing Digital Images": over, not premultiplied.
// Contract: alpha 1 gives the layer and alpha 0 what lies behind, bit for bit (HARD-CASES T5).
namespace transparency::alpha {
template <class F> SPANRAY_FORMULA F over(F alpha, F layer, F behind) {
  const F one = number<F>(1.0f);
  const F blended = alpha * layer + (one - alpha) * behind;
  // Written out: 0 * infinity, and -0 + 0, would break the identities.
  return select(alpha >= one, layer, select(alpha > number<F>(0.0f), blended, behind));
}
}  // namespace transparency::alpha
