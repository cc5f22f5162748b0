#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace atrium::scene {

/// Streaming 64-bit hash for checksums and identities (not for adversaries): every 8-byte word is
/// folded in by a multiplication and a shift, so that a single changed bit changes the result.
class Hash64 {
 public:
  void bytes(const void* data, std::size_t size) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (; size >= 8; size -= 8, p += 8) {
      std::uint64_t w;
      std::memcpy(&w, p, 8);
      word(w);
    }
    std::uint64_t tail = size;  // the length keeps "a" and "a\0" apart
    for (std::size_t i = 0; i < size; ++i) tail = (tail << 8) | p[i];
    word(tail);
  }
  void word(std::uint64_t w) {
    h_ = (h_ ^ w) * 0x9e3779b97f4a7c15ULL;
    h_ ^= h_ >> 32;
  }
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void value(T v) {
    std::uint64_t w = 0;
    std::memcpy(&w, &v, sizeof v);
    word(w);
  }
  void text(const std::string& s) { bytes(s.data(), s.size()); }
  /// Elements must have no padding.
  template <class T>
  void array(const std::vector<T>& v) {
    word(v.size());
    bytes(v.data(), v.size() * sizeof(T));
  }
  [[nodiscard]] std::uint64_t result() const { return h_; }

 private:
  std::uint64_t h_ = 0xcbf29ce484222325ULL;
};

}  // namespace atrium::scene
