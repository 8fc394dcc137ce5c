// SPDX-License-Identifier: Apache-2.0
// Files that `robdef inspect` and `replay` read. The sums are made right, so that damage is looked
// for behind them as well; the first byte says whether.
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <variant>
#include <vector>

#include "rr/crc32.hpp"
#include "rr/error.hpp"
#include "rr/recording.hpp"
#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/src/tap/format.hpp"

using rr::fuzz::promise;

namespace {

void put_sum(std::span<std::byte> bytes, std::size_t at, std::uint32_t sum) {
  std::memcpy(bytes.data() + at, &sum, sizeof sum);
}

void mend(std::vector<std::byte>& file) {
  using rr::tap::FileHeader;
  using rr::tap::RecordHeader;
  std::span<std::byte> rest(file);
  if (rest.size() < FileHeader::size) return;
  std::memcpy(rest.data(), rr::tap::magic.data(), rr::tap::magic.size());
  put_sum(rest, FileHeader::sum_at, rr::crc32(rest.first(FileHeader::sum_at)));
  rest = rest.subspan(FileHeader::size);
  while (rest.size() >= RecordHeader::size) {
    RecordHeader header;
    rr::tap::read(rest, header);
    const std::size_t left = rest.size() - RecordHeader::size;
    if (header.body_size > left) header.body_size %= static_cast<std::uint32_t>(left + 1);
    std::memcpy(rest.data(), &header.body_size, sizeof header.body_size);
    const std::span<std::byte> record = rest.first(RecordHeader::size + header.body_size);
    put_sum(record, RecordHeader::sum_at, rr::tap::record_sum(record));
    rest = rest.subspan(record.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::byte> input = rr::fuzz::input_of(data, size);
  const bool is_mended = (rr::fuzz::take_byte(input) & 1U) != 0;
  std::vector<std::byte> file(input.begin(), input.end());
  if (is_mended) mend(file);
  const int memory = ::memfd_create("recording", MFD_CLOEXEC);
  promise(
      memory >= 0 && ::write(memory, file.data(), file.size()) == static_cast<ssize_t>(file.size()),
      "there is a file in memory");
  try {
    rr::Recording recording("/proc/self/fd/" + std::to_string(memory));
    rr::Record record;
    std::size_t bytes = 0;
    std::size_t count = 0;
    while (recording.next(record)) {
      ++count;
      if (const auto* message = std::get_if<rr::RecordedMessage>(&record.what)) {
        bytes += message->bytes.size();
      }
    }
    promise(bytes + count * rr::tap::RecordHeader::size <= file.size(),
            "no more is read than the file has");
  } catch (const rr::Error&) {
    // No recording.
  }
  ::close(memory);
  return 0;
}
