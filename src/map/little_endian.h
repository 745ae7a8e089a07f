// Numbers and texts as bytes, little endian whatever the host is.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "edgeslam/input_error.h"

namespace edgeslam {

static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == 8);

// Called with fields of type int32, int64, double, bool or string, appends them in turn.
class ByteWriter {
 public:
  template <typename... Fields>
  void operator()(const Fields&... fields) {
    (field(fields), ...);
  }
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void raw(std::string_view content) { bytes_.append(content); }

  // A u64 that tells the length of all that follows it until endLength(), which takes what this returned.
  std::size_t beginLength() {
    u64(0);
    return bytes_.size();
  }
  void endLength(std::size_t begin) {
    const std::uint64_t length = bytes_.size() - begin;
    for (std::size_t i = 0; i < 8; ++i) bytes_[begin - 8 + i] = byteOf(length, i);
  }

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  void field(std::int32_t value) { put(static_cast<std::uint32_t>(value), 4); }
  void field(std::int64_t value) { put(static_cast<std::uint64_t>(value), 8); }
  void field(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    put(bits, 8);
  }
  void field(bool value) { put(value ? 1 : 0, 1); }
  void field(const std::string& text) {
    u64(text.size());
    raw(text);
  }
  void put(std::uint64_t value, std::size_t width) {
    for (std::size_t i = 0; i < width; ++i) bytes_.push_back(byteOf(value, i));
  }
  static char byteOf(std::uint64_t value, std::size_t place) { return static_cast<char>(value >> (8 * place) & 0xFF); }

  std::string bytes_;
};

// Reads what a ByteWriter wrote. Nothing is taken on trust: every length is held against the bytes that are there.
// Throws InputError "NAME: byte OFFSET: ...".
class ByteReader {
 public:
  // Of `bytes` the part from `begin` on; offsets in messages count from the start of `bytes`, which must outlive this.
  ByteReader(std::string_view bytes, std::size_t begin, std::string name)
      : bytes_(bytes), position_(begin), name_(std::move(name)) {}

  template <typename... Fields>
  void operator()(Fields&... fields) {
    (field(fields), ...);
  }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::string_view raw(std::uint64_t size) {
    if (size > left()) fail(std::to_string(size) + " bytes expected, " + std::to_string(left()) + " are left");
    const std::string_view content = bytes_.substr(position_, static_cast<std::size_t>(size));
    position_ += content.size();
    return content;
  }
  // Number of records that follow, each of `least_size` bytes or more.
  std::size_t count(std::size_t least_size) {
    const std::uint64_t records = u64();
    if (records > left() / least_size) fail(std::to_string(records) + " records cannot be in what follows");
    return static_cast<std::size_t>(records);
  }
  // The next `size` bytes, to be read apart.
  ByteReader part(std::uint64_t size) {
    const std::size_t begin = position_;
    raw(size);
    return ByteReader(bytes_.substr(0, position_), begin, name_);
  }
  void expectEnd() const {
    if (left() > 0) fail(std::to_string(left()) + " bytes too many");
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(name_ + ": byte " + std::to_string(position_) + ": " + problem);
  }

 private:
  void field(std::int32_t& value) { value = static_cast<std::int32_t>(u32()); }
  void field(std::int64_t& value) { value = static_cast<std::int64_t>(u64()); }
  void field(double& value) {
    const std::uint64_t bits = u64();
    std::memcpy(&value, &bits, sizeof value);
  }
  void field(bool& value) {
    const std::uint64_t flag = number(1);
    if (flag > 1) fail("expected 0 or 1, found " + std::to_string(flag));
    value = flag == 1;
  }
  void field(std::string& text) { text = raw(u64()); }
  std::size_t left() const { return bytes_.size() - position_; }
  std::uint64_t number(std::size_t width) {
    const std::string_view digits = raw(width);
    std::uint64_t value = 0;
    for (std::size_t i = width; i-- > 0;) value = value << 8 | static_cast<unsigned char>(digits[i]);
    return value;
  }

  std::string_view bytes_;
  std::size_t position_;
  std::string name_;
};

}  // namespace edgeslam
