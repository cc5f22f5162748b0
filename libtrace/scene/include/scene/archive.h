#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "material/error.h"

namespace atrium::scene {

static_assert(std::endian::native == std::endian::little, "archives are little endian");

/// Appends values; vectors with their length. Elements of vectors must have no padding.
///
/// Writer and reader are called alike, so that one list of members serves both directions.
class ArchiveWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const T& v) { raw(&v, sizeof v); }
  template <class T, class A>
  void operator()(const std::vector<T, A>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    (*this)(static_cast<std::uint64_t>(v.size()));
    raw(v.data(), v.size() * sizeof(T));
  }
  void operator()(const std::string& s) {
    (*this)(static_cast<std::uint64_t>(s.size()));
    raw(s.data(), s.size());
  }
  void raw(const void* data, std::size_t size) {
    const char* p = static_cast<const char*>(data);
    bytes.insert(bytes.end(), p, p + size);
  }
  std::vector<char> bytes;
};

/// Takes values off; nothing is allocated that the bytes do not contain.
class ArchiveReader {
 public:
  /// \param name  of the file, for messages.
  ArchiveReader(const char* begin, const char* end, std::string name)
      : at_(begin), end_(end), name_(std::move(name)) {}
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& v) { raw(&v, sizeof v); }
  template <class T, class A>
  void operator()(std::vector<T, A>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    v.resize(count(sizeof(T)));
    raw(v.data(), v.size() * sizeof(T));
  }
  /// Another byte than 0 and 1 is no bool, not even one to look at.
  void operator()(bool& v) {
    std::uint8_t byte = 0;
    (*this)(byte);
    if (byte > 1) damaged();
    v = byte == 1;
  }
  void operator()(std::string& s) {
    s.resize(count(1));
    raw(s.data(), s.size());
  }
  /// Length of a list whose items take `item_size` bytes or more.  \throws Error  if it cannot be.
  [[nodiscard]] std::size_t count(std::size_t item_size) {
    std::uint64_t n = 0;
    (*this)(n);
    if (n > static_cast<std::uint64_t>(end_ - at_) / item_size) damaged();
    return static_cast<std::size_t>(n);
  }
  [[noreturn]] void damaged() const { throw Error(name_ + ": is damaged"); }

 private:
  void raw(void* data, std::size_t size) {
    if (size > static_cast<std::size_t>(end_ - at_)) damaged();
    if (size != 0) std::memcpy(data, at_, size);
    at_ += size;
  }
  const char* at_;
  const char* end_;
  std::string name_;
};

}  // namespace atrium::scene
