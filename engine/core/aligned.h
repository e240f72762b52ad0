// A growable array of plain values on 64-byte boundaries, without initialisation and with readable padding.
#pragma once
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

namespace spanray {

template <class T> class AlignedBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  static constexpr size_t kPadding = 64;  // bytes past the end that may be read (and overwritten, if size allows it)
  AlignedBuffer() = default;
  explicit AlignedBuffer(size_t n) { resize(n); }
  AlignedBuffer(AlignedBuffer&& o) noexcept { swap(o); }
  AlignedBuffer& operator=(AlignedBuffer&& o) noexcept { swap(o); return *this; }
  AlignedBuffer(const AlignedBuffer&) = delete;
  AlignedBuffer& operator=(const AlignedBuffer&) = delete;
  ~AlignedBuffer() { release(); }

  // Another name for the elements of o, which must outlive it; they must not be written through it. It holds no memory of its own
  // until it grows.
  static AlignedBuffer borrow(const AlignedBuffer& o) {
    AlignedBuffer b;
    b.data_ = o.data_, b.size_ = b.capacity_ = o.size_, b.borrowed_ = true;
    return b;
  }
  static AlignedBuffer copy(const AlignedBuffer& o) {
    AlignedBuffer b(o.size_);
    if (o.size_ > 0) std::memcpy(static_cast<void*>(b.data_), o.data_, o.size_ * sizeof(T));
    return b;
  }

  // Keeps the first min(size, n) elements; new elements are not initialised. Throws std::bad_alloc.
  void resize(size_t n) {
    if (n > capacity_) reserve(n > capacity_ * 2 ? n : capacity_ * 2);
    size_ = n;
  }
  void reserve(size_t n) {
    if (n <= capacity_) return;
    const size_t bytes = (n * sizeof(T) + kPadding + 63) / 64 * 64;
    T* p = static_cast<T*>(std::aligned_alloc(64, bytes));
    if (p == nullptr) throw std::bad_alloc();
    if (size_ > 0) std::memcpy(static_cast<void*>(p), data_, size_ * sizeof(T));
    std::memset(static_cast<void*>(p + n), 0, bytes - n * sizeof(T));
    release();
    data_ = p;
    capacity_ = n;
    borrowed_ = false;
  }
  void assign(size_t n, const T& value) {
    resize(n);
    for (size_t i = 0; i < n; ++i) data_[i] = value;
  }
  void push_back(const T& value) {
    const T copy = value;
    resize(size_ + 1);
    data_[size_ - 1] = copy;
  }
  void clear() { size_ = 0; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  size_t bytes() const { return borrowed_ ? 0 : capacity_ * sizeof(T); }
  T& operator[](size_t i) { return data_[i]; }
  const T& operator[](size_t i) const { return data_[i]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  void swap(AlignedBuffer& o) noexcept {
    std::swap(data_, o.data_);
    std::swap(size_, o.size_);
    std::swap(capacity_, o.capacity_);
    std::swap(borrowed_, o.borrowed_);
  }

 private:
  void release() {
    if (!borrowed_) std::free(data_);
  }
  T* data_ = nullptr;
  size_t size_ = 0, capacity_ = 0;
  bool borrowed_ = false;
};

}  // namespace spanray
