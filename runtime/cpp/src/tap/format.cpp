// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/tap/format.hpp"

#include <cstring>

namespace rr::tap {
namespace {

// Eight tables, so that eight bytes are summed at a time: the writer sums all that it writes.
constexpr std::size_t stride = 8;
using Tables = std::array<std::array<std::uint32_t, 256>, stride>;

constexpr Tables make_tables() {
  constexpr std::uint32_t polynomial = 0xEDB88320;
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? polynomial : 0);
    tables[0][byte] = sum;
  }
  for (std::size_t table = 1; table < stride; ++table) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[table - 1][byte];
      tables[table][byte] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}

constexpr Tables tables = make_tables();

template <class T>
void put(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof value);
}

template <class T>
void take(const std::byte* from, T& value) {
  std::memcpy(&value, from, sizeof value);
}

}  // namespace

std::uint32_t checksum(std::span<const std::byte> bytes, std::uint32_t sum) {
  sum = ~sum;
  while (bytes.size() >= stride) {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    take(bytes.data(), low);
    take(bytes.data() + 4, high);
    low ^= sum;
    sum = tables[7][low & 0xFF] ^ tables[6][low >> 8 & 0xFF] ^ tables[5][low >> 16 & 0xFF] ^
          tables[4][low >> 24] ^ tables[3][high & 0xFF] ^ tables[2][high >> 8 & 0xFF] ^
          tables[1][high >> 16 & 0xFF] ^ tables[0][high >> 24];
    bytes = bytes.subspan(stride);
  }
  for (const std::byte each : bytes) {
    sum = (sum >> 8) ^ tables[0][(sum ^ std::to_integer<std::uint32_t>(each)) & 0xFF];
  }
  return ~sum;
}

std::uint32_t record_sum(std::span<const std::byte> record) {
  const std::uint32_t before = checksum(record.first(RecordHeader::sum_at));
  return checksum(record.subspan(RecordHeader::sum_at + sizeof(std::uint32_t)), before);
}

std::array<std::byte, FileHeader::size> bytes_of(const FileHeader& header) {
  std::array<std::byte, FileHeader::size> bytes{};
  std::memcpy(bytes.data(), magic.data(), magic.size());
  put(bytes.data() + 8, header.version);
  put(bytes.data() + 10, header.header_size);
  put(bytes.data() + 16, header.start);
  put(bytes.data() + FileHeader::sum_at, checksum(std::span(bytes).first(FileHeader::sum_at)));
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
  return sum == checksum(bytes.first(FileHeader::sum_at));
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
