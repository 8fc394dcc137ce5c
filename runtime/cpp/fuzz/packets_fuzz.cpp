// SPDX-License-Identifier: Apache-2.0
// The ring of a pipe, of a service that may have written anything to it, and the words of a reader
// that may say anything: what is read is a packet or is refused, and what a service takes for
// missed is what it has put in.
#include <algorithm>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/fuzz/published_copy.hpp"
#include "runtime/cpp/src/channel/pipe_ring.hpp"
#include "runtime/cpp/src/channel/shared_header.hpp"

using rr::fuzz::promise;
using rr::fuzz::take_byte;

namespace {

using rr::channel::PipeCursor;
using rr::channel::PipeRingReader;
using rr::channel::PipeRingSize;
using rr::channel::PipeRingWriter;
using rr::channel::RingPacket;
using Words = rr::channel::SlotHolds::Words;

constexpr std::size_t untils_at = rr::channel::SharedHeader::first_data;
constexpr std::size_t packets_at =
    untils_at + sizeof(std::uint64_t) * rr::channel::pipe_ring_readers;
constexpr PipeRingSize ring_size{PipeRingSize::smallest};
// Of the memory that is put back before each run.
constexpr std::size_t used = packets_at + std::size_t{16} * 1024;

std::vector<std::byte> sample(std::size_t items) {
  rr::VarStringMap value;
  value["name"] = std::string("arm");
  value["trace"] = rr::Array<double>(items);
  rr::Writer writer;
  writer.reset(rr::MessageVersion::v4);
  rr::type_of<rr::VarStringMap>.write(writer, "packet", &value);
  std::vector<std::byte> bytes;
  for (const rr::Piece& piece : writer.pieces()) {
    bytes.insert(bytes.end(), piece.data, piece.data + piece.size);
  }
  return bytes;
}

// Three packets, as a service has put them in.
rr::fuzz::PublishedCopy published() {
  std::error_code error;
  const auto writer = PipeRingWriter::make(ring_size, 42, error);
  promise(writer != nullptr, "there is a memory");
  promise(writer->admit() == 0U, "the first reader");
  for (const std::size_t items : {4U, 900U, 20U}) writer->put(sample(items));
  promise(writer->position() < used - packets_at, "the sample is short");
  return {writer->handle(), ring_size.memory(), used};
}

// Places are within the words, those of the first readers, or the packets.
void overwrite(rr::fuzz::PublishedCopy& memory, std::span<const std::byte>& input) {
  const std::uint8_t where = take_byte(input);
  std::size_t at = take_byte(input) | std::size_t{take_byte(input)} << 8;
  if ((where & 0x80) != 0) {
    at = packets_at + at % (used - packets_at);
  } else {
    at = (where & 0x40) != 0 ? untils_at + at % 0x10 : at % 0x200;
  }
  memory.write(input, where, at);
}

void decode(const RingPacket& packet) {
  static const auto types = std::make_shared<const rr::TypeRegistry>();
  rr::Decoder decoder(rr::MessageVersion::v4, nullptr, packet.owner, types.get());
  rr::ElementReader elements(decoder, packet.bytes, 1);
  rr::VarStringMap value;
  rr::Element element;
  if (elements.next(element)) rr::type_of<rr::VarStringMap>.read(decoder, element, &value);
}

void read(std::span<const std::byte> input) {
  static rr::fuzz::PublishedCopy memory = published();
  memory.reset();
  const std::uint8_t mode = take_byte(input);
  for (int left = mode >> 4; left != 0 && !input.empty(); --left) overwrite(memory, input);
  std::error_code error;
  const auto reader = PipeRingReader::open(memory.handle(), error);
  if (!reader) return;
  const auto words = std::make_shared<Words>();
  const std::uint64_t begin = mode & 8U;
  promise(reader->begin(std::make_shared<PipeCursor>(words), {.position = begin, .turn = 1}),
          "a record may be there");
  for (int i = 0; i < 8; ++i) {
    RingPacket packet;
    const auto found = reader->read(packet);
    if (found == PipeRingReader::Found::wrong) return;
    if (found == PipeRingReader::Found::packet) {
      promise(packet.bytes.size() <= ring_size.ring, "a packet is in its ring");
      decode(packet);
    } else {
      static_cast<void>(reader->ask());
    }
    while (!input.empty() && take_byte(input) % 4 != 0) overwrite(memory, input);
  }
}

// A service with what a reader says.
void serve(std::span<const std::byte> input) {
  std::error_code error;
  static const auto writer = PipeRingWriter::make(ring_size, 42, error);
  const std::uint8_t count = take_byte(input);
  for (int i = 0; i < count; ++i) {
    const std::vector<std::byte> packet(static_cast<std::size_t>(take_byte(input)) * 37,
                                        std::byte{1});
    if (const std::uint64_t position = writer->must_give_up(packet.size())) {
      writer->give_up(position);
    }
    writer->put(packet);
  }
  std::uint64_t said = 0;
  const std::size_t size = std::min(sizeof said, input.size());
  std::memcpy(&said, input.data(), size);
  const std::uint64_t cursor = (count & 1) != 0 ? said : writer->position() - said;
  if (!writer->has(cursor)) return;
  std::size_t bytes = 0;
  writer->for_each_from(cursor, [&](const rr::Allocation& packet, std::size_t packet_size) {
    bytes += rr::channel::PipeRecord::whole(packet_size);
    if (packet_size != 0) promise(packet.bytes != nullptr, "a packet that is missed is there");
  });
  promise(bytes <= writer->position() - cursor, "no more is missed than was put in");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::byte> input = rr::fuzz::input_of(data, size);
  if (take_byte(input) % 4 == 0) {
    serve(input);
  } else {
    read(input);
  }
  return 0;
}
