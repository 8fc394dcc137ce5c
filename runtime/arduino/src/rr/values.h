// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "status.h"

/// Values as they lie in a frame: packed, lowest byte first, each of a bounded size.
namespace rr {

/// A string of at most `Limit` bytes of UTF-8, stored in place and always ended by a zero.
template <uint8_t Limit>
struct Text {
  char bytes[Limit + 1];

  Text() { bytes[0] = 0; }
  Text(const char* text) { *this = text; }
  /// What is longer is cut.
  Text& operator=(const char* text) {
    memccpy(bytes, text, 0, Limit);
    bytes[Limit] = 0;
    return *this;
  }
  const char* c_str() const { return bytes; }
  uint8_t length() const { return static_cast<uint8_t>(strlen(bytes)); }
  bool operator==(const char* text) const { return strcmp(bytes, text) == 0; }
};

/// `T[n]` and `T[m,n]`: all `Count` items, those of the first dimension beside each other.
template <class T, uint8_t Count>
struct Fixed {
  T items[Count];

  T& operator[](uint8_t index) { return items[index]; }
  const T& operator[](uint8_t index) const { return items[index]; }
  static constexpr uint8_t size() { return Count; }
};

/// `T[n-]`: at most `Limit` items.
template <class T, uint8_t Limit>
struct Bounded {
  uint8_t count;
  T items[Limit];

  Bounded() : count(0) {}
  T& operator[](uint8_t index) { return items[index]; }
  const T& operator[](uint8_t index) const { return items[index]; }
  uint8_t size() const { return count; }
  /// False, and nothing done, when it is full.
  bool add(const T& item) {
    if (count == Limit) return false;
    items[count++] = item;
    return true;
  }
};

/// A complex number.
template <class T>
struct Complex {
  T real;
  T imaginary;
};

/// Takes values out of the body of a frame. When one is not there, or is none of its type, it and
/// all that follow are false.
class Reader {
 public:
  Reader(const uint8_t* bytes, uint8_t count)
      : at_(bytes), left_(count), isGood_(true), refusal_(Status::DataTypeMismatch) {}

  /// Whether everything was read, and no more is there.
  bool isComplete() const { return isGood_ && left_ == 0; }
  /// What a request that is not complete is refused with.
  Status refusal() const { return refusal_; }
  /// `size` bytes, lowest first, into a number of this machine.
  bool take(void* number, uint8_t size);
  /// The next `size` bytes, which are passed over. Null where there are fewer.
  const uint8_t* skip(uint8_t size);
  /// The length before a string or bounded array; false when it is more than `limit`, which is
  /// refused with BufferLimitViolation.
  bool takeCount(uint8_t& count, uint8_t limit);

 private:
  const uint8_t* at_;
  uint8_t left_;
  bool isGood_;
  Status refusal_;
};

/// Puts values into the body of a frame. Once one has not fitted, none does.
class Writer {
 public:
  Writer(uint8_t* bytes, uint8_t room) : start_(bytes), count_(0), room_(room), isGood_(true) {}

  bool isGood() const { return isGood_; }
  uint8_t count() const { return count_; }
  uint8_t room() const { return static_cast<uint8_t>(room_ - count_); }
  bool put(const void* number, uint8_t size);
  bool putByte(uint8_t byte) { return put(&byte, 1); }
  /// Room for the next `size` bytes, to be filled in. Null where there is less.
  uint8_t* skip(uint8_t size);

 private:
  uint8_t* start_;
  uint8_t count_;
  uint8_t room_;
  bool isGood_;
};

inline bool read(Reader& reader, int8_t& value) { return reader.take(&value, 1); }
inline bool read(Reader& reader, uint8_t& value) { return reader.take(&value, 1); }
inline bool read(Reader& reader, int16_t& value) { return reader.take(&value, 2); }
inline bool read(Reader& reader, uint16_t& value) { return reader.take(&value, 2); }
inline bool read(Reader& reader, int32_t& value) { return reader.take(&value, 4); }
inline bool read(Reader& reader, uint32_t& value) { return reader.take(&value, 4); }
inline bool read(Reader& reader, int64_t& value) { return reader.take(&value, 8); }
inline bool read(Reader& reader, uint64_t& value) { return reader.take(&value, 8); }
inline bool read(Reader& reader, float& value) { return reader.take(&value, 4); }
bool read(Reader& reader, bool& value);
/// Where a double has four bytes it becomes the nearest of those, or infinite.
bool read(Reader& reader, double& value);

// By reference, for put() wants an address.
inline bool write(Writer& writer, const int8_t& value) { return writer.put(&value, 1); }
inline bool write(Writer& writer, const uint8_t& value) { return writer.put(&value, 1); }
inline bool write(Writer& writer, const int16_t& value) { return writer.put(&value, 2); }
inline bool write(Writer& writer, const uint16_t& value) { return writer.put(&value, 2); }
inline bool write(Writer& writer, const int32_t& value) { return writer.put(&value, 4); }
inline bool write(Writer& writer, const uint32_t& value) { return writer.put(&value, 4); }
inline bool write(Writer& writer, const int64_t& value) { return writer.put(&value, 8); }
inline bool write(Writer& writer, const uint64_t& value) { return writer.put(&value, 8); }
inline bool write(Writer& writer, const float& value) { return writer.put(&value, 4); }
inline bool write(Writer& writer, bool value) { return writer.putByte(value ? 1 : 0); }
bool write(Writer& writer, const double& value);

/// The eight bytes of a double, lowest first, of the four of a float: exactly, and back, rounded to
/// the nearest, of two equally near ones to the even one.
void widen(uint32_t single, uint8_t* wide);
uint32_t narrow(const uint8_t* wide);

template <class T>
bool read(Reader& reader, Complex<T>& value) {
  return read(reader, value.real) && read(reader, value.imaginary);
}
template <class T>
bool write(Writer& writer, const Complex<T>& value) {
  return write(writer, value.real) && write(writer, value.imaginary);
}

template <uint8_t Limit>
bool read(Reader& reader, Text<Limit>& value) {
  uint8_t count = 0;
  if (!reader.takeCount(count, Limit)) return false;
  value.bytes[count] = 0;
  for (uint8_t index = 0; index < count; ++index) {
    if (!reader.take(value.bytes + index, 1) || value.bytes[index] == 0) return false;
  }
  return true;
}
template <uint8_t Limit>
bool write(Writer& writer, const Text<Limit>& value) {
  const uint8_t count = value.length();
  bool isGood = writer.putByte(count);
  for (uint8_t index = 0; index < count; ++index) isGood = writer.put(value.bytes + index, 1);
  return isGood;
}

// Items may have their read and write in the namespace of their definition: found by their type.
template <class T, uint8_t Count>
bool read(Reader& reader, Fixed<T, Count>& value) {
  for (uint8_t index = 0; index < Count; ++index) {
    if (!read(reader, value.items[index])) return false;
  }
  return true;
}
template <class T, uint8_t Count>
bool write(Writer& writer, const Fixed<T, Count>& value) {
  for (uint8_t index = 0; index < Count; ++index) {
    if (!write(writer, value.items[index])) return false;
  }
  return true;
}

template <class T, uint8_t Limit>
bool read(Reader& reader, Bounded<T, Limit>& value) {
  if (!reader.takeCount(value.count, Limit)) return false;
  for (uint8_t index = 0; index < value.count; ++index) {
    if (!read(reader, value.items[index])) return false;
  }
  return true;
}
template <class T, uint8_t Limit>
bool write(Writer& writer, const Bounded<T, Limit>& value) {
  const uint8_t count = value.count < Limit ? value.count : Limit;
  if (!writer.putByte(count)) return false;
  for (uint8_t index = 0; index < count; ++index) {
    if (!write(writer, value.items[index])) return false;
  }
  return true;
}

}  // namespace rr
