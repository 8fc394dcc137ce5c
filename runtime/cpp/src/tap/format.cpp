// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/tap/format.hpp"

#include <cstring>

#include "rr/crc32.hpp"

namespace rr::tap {
namespace {

template <class T>
void put(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

template <class T>
void take(const std::byte* from, T& value) {
  std::memcpy(&value, from, sizeof value);
}

}  // namespace

std::uint32_t record_sum(std::span<const std::byte> record) {
  const std::uint32_t before = crc32(record.first(RecordHeader::sum_at));
  return crc32(record.subspan(RecordHeader::sum_at + sizeof(std::uint32_t)), before);
}

std::array<std::byte, FileHeader::size> bytes_of(const FileHeader& header) {
  std::array<std::byte, FileHeader::size> bytes{};
  std::memcpy(bytes.data(), magic.data(), magic.size());
  put(bytes.data() + 8, header.version);
  put(bytes.data() + 10, header.header_size);
  put(bytes.data() + 16, header.start);
  put(bytes.data() + FileHeader::sum_at, crc32(std::span(bytes).first(FileHeader::sum_at)));
  return bytes;
}

std::array<std::byte, RecordHeader::size> bytes_of(const RecordHeader& header) {
  std::array<std::byte, RecordHeader::size> bytes{};
  put(bytes.data(), header.body_size);
  put(bytes.data() + 4, header.kind);
  put(bytes.data() + 5, header.direction);
  put(bytes.data() + 8, header.connection);
  put(bytes.data() + RecordHeader::sum_at, header.sum);
  put(bytes.data() + 16, header.time);
  return bytes;
}

bool read(std::span<const std::byte> bytes, FileHeader& header) {
  if (std::memcmp(bytes.data(), magic.data(), magic.size()) != 0) return false;
  take(bytes.data() + 8, header.version);
  take(bytes.data() + 10, header.header_size);
  take(bytes.data() + 16, header.start);
  std::uint32_t sum = 0;
  take(bytes.data() + FileHeader::sum_at, sum);
  return sum == crc32(bytes.first(FileHeader::sum_at));
}

void read(std::span<const std::byte> bytes, RecordHeader& header) {
  take(bytes.data(), header.body_size);
  take(bytes.data() + 4, header.kind);
  take(bytes.data() + 5, header.direction);
  take(bytes.data() + 8, header.connection);
  take(bytes.data() + RecordHeader::sum_at, header.sum);
  take(bytes.data() + 16, header.time);
}

}  // namespace rr::tap
