// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// The layout of a recording (docs/howto/recording.md), for its writer and its reader.
namespace rr::tap {

inline constexpr std::string_view magic("RRTAPE\x1a\n", 8);
inline constexpr std::uint16_t format_version = 1;

enum class Kind : std::uint8_t {
  end = 0,
  message = 1,
  opened = 2,
  agreed = 3,
  closed = 4,
  definition = 5,
  lost = 6,
  replaced = 7,
};

/// At the front of the file.
struct FileHeader {
  static constexpr std::size_t size = 32;
  static constexpr std::size_t sum_at = 28;

  std::uint16_t version = format_version;
  std::uint16_t header_size = size;
  std::int64_t start = 0;  ///< nanoseconds since 1970, UTC
};

/// In front of each record.
struct RecordHeader {
  static constexpr std::size_t size = 24;
  static constexpr std::size_t sum_at = 12;

  std::uint32_t body_size = 0;
  Kind kind = Kind::end;
  std::uint8_t direction = 0;
  std::uint32_t connection = 0;
  std::uint32_t sum = 0;
  std::uint64_t time = 0;  ///< nanoseconds since the start
};

namespace agreed_flag {
inline constexpr std::uint8_t combined = 1, local_strings = 2, standard_strings = 4;
}

std::array<std::byte, FileHeader::size> bytes_of(const FileHeader& header);
std::array<std::byte, RecordHeader::size> bytes_of(const RecordHeader& header);
/// False when the bytes, of the size of the header, are not its.
bool read(std::span<const std::byte> bytes, FileHeader& header);
void read(std::span<const std::byte> bytes, RecordHeader& header);

/// The CRC-32 of a record, over its header without the sum, then its body.
std::uint32_t record_sum(std::span<const std::byte> record);

/// Collects the body of a record.
class BodyWriter {
 public:
  template <class T>
  void number(T value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
  }
  void raw(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    raw(std::as_bytes(std::span(text.data(), text.size())));
  }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes the body of a record apart. What is not there latches failed() and reads as nothing.
class BodyReader {
 public:
  explicit BodyReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    T value{};
    const std::span<const std::byte> bytes = raw(sizeof value);
    auto* to = reinterpret_cast<std::byte*>(&value);
    for (const std::byte each : bytes) *to++ = each;
    return value;
  }
  std::span<const std::byte> raw(std::size_t size) {
    if (size > bytes_.size()) {
      failed_ = true;
      size = 0;
    }
    const std::span<const std::byte> result = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return result;
  }
  std::string_view text() {
    const std::span<const std::byte> bytes = raw(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  std::span<const std::byte> bytes_;
  bool failed_ = false;
};

}  // namespace rr::tap
