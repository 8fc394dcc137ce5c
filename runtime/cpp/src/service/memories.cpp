// SPDX-License-Identifier: Apache-2.0
// Requests to memories (07, section 13). Nothing is allocated before a part is known to lie inside
// and to fit into a message.
#include "rr/memories.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/piece_memory.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"
#include "runtime/cpp/src/value/items.hpp"
#include "runtime/cpp/src/value/memory_form.hpp"

namespace rr {

std::shared_ptr<MemorySource> Skeleton::rr_memory(std::size_t /*member*/) { return nullptr; }

namespace service {
namespace {

using Numbers = Array<std::uint64_t>;

// Bytes whose reading keeps others waiting for long.
constexpr std::size_t long_part = std::size_t{128} * 1024;

// The part that a request names, in as many numbers as it has, and in one for each dimension.
struct Part {
  Numbers named_position;
  Numbers named_count;
  std::vector<std::uint64_t> position;
  std::vector<std::uint64_t> count;
  std::size_t size = 0;  // items
};

Error outside(bool is_multi) {
  return is_multi ? Error(ErrorCode::invalid_argument, "the part does not lie inside the memory")
                  : Error(ErrorCode::out_of_range, "Index out of range");
}

Numbers read_numbers(Decoder& decoder, const Entry& entry, std::string_view name, bool is_multi) {
  Numbers numbers;
  if (is_multi) {
    endpoint::read_value(decoder, entry, name, type_of<Numbers>, &numbers);
  } else {
    std::uint64_t number = 0;
    endpoint::read_value(decoder, entry, name, type_of<std::uint64_t>, &number);
    numbers = {number};
  }
  return numbers;
}

// Dimensions that a request leaves out are taken at their begin, one item wide.
void place(Part& part, const std::vector<std::uint64_t>& dims, bool is_multi) {
  const std::size_t named = part.named_count.size();
  if (named == 0 || named != part.named_position.size() || named > dims.size()) {
    throw outside(is_multi);
  }
  part.position.assign(dims.size(), 0);
  part.count.assign(dims.size(), 1);
  std::copy(part.named_position.begin(), part.named_position.end(), part.position.begin());
  std::copy(part.named_count.begin(), part.named_count.end(), part.count.begin());
  bool is_empty = false;
  for (std::size_t i = 0; i < dims.size(); ++i) {
    if (part.position[i] > dims[i] || part.count[i] > dims[i] - part.position[i]) {
      throw outside(is_multi);
    }
    is_empty = is_empty || part.count[i] == 0;
  }
  part.size = is_empty ? 0 : 1;
  for (std::size_t i = 0; i < dims.size() && !is_empty; ++i) {
    if (__builtin_mul_overflow(part.size, part.count[i], &part.size)) throw outside(is_multi);
  }
}

std::vector<std::uint32_t> short_numbers(const Numbers& numbers) {
  std::vector<std::uint32_t> result;
  for (const std::uint64_t number : numbers) result.push_back(static_cast<std::uint32_t>(number));
  return result;
}

// What is larger than a message that may be sent is not read: senders stop this much earlier than
// receivers (04, section 3), and the answer repeats path and member.
void check_size(const Part& part, std::size_t item_size, std::size_t limit, const Entry& entry) {
  const std::size_t around = 100 + entry.service_path.size() + entry.member.size();
  const std::size_t room = limit > around ? limit - around : 0;
  if (part.size > room / item_size) {
    throw Error(ErrorCode::protocol_error, "the part is too large for one message");
  }
}

// Draws the bytes of a part before the memory is read, which may be user code.
channel::Charge charge_part(const Part& part, std::size_t item_size,
                            const channel::Connection& connection) {
  channel::Charge charge(connection.account());
  if (!charge.add(part.size * item_size)) {
    throw Error(ErrorCode::out_of_system_resource,
                "the part is larger than what this client may make the node hold");
  }
  return charge;
}

// Elements of an answer to a read or write. A value lives until it is written.
struct PartElements {
  PartElements(const Part& part, bool is_multi, bool is_read) {
    const Type& type = is_multi ? type_of<Numbers> : type_of<std::uint64_t>;
    // What existing services answer to a read of several dimensions (07, section 17).
    const Numbers& count = is_multi && is_read ? part.named_position : part.named_count;
    add("memorypos", type,
        is_multi ? static_cast<const void*>(&part.named_position) : part.named_position.data());
    add("count", type, is_multi ? static_cast<const void*>(&count) : count.data());
  }
  void add(std::string_view name, const Type& type, const void* value) {
    parameters[size] = {name, &type};
    values[size++] = value;
  }
  [[nodiscard]] std::span<const Parameter> used() const { return {parameters.data(), size}; }

  std::array<Parameter, 3> parameters{};
  std::array<const void*, 3> values{};
  std::size_t size = 0;
};

}  // namespace

void ServerEndpoint::answer_memory(const Question& question) {
  const Entry& entry = question.entry;
  const auto object = find_object(entry.service_path);
  const Member& member = find_member(*object, entry.member, MemberKind::memory);
  if (entry.type == EntryType::memory_write && (member.access & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only member");
  }
  if (entry.type == EntryType::memory_read && (member.access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only member");
  }
  const auto number = static_cast<std::size_t>(&member - object->type->members.data());
  const std::shared_ptr<MemorySource> memory = object->skeleton->rr_memory(number);
  if (!memory) throw Error(ErrorCode::invalid_operation, "the service has not set the memory");
  Decoder decoder = question.decoder(host_->types().get());
  switch (entry.type) {
    case EntryType::memory_read:
      read_memory(question, decoder, member, *memory);
      break;
    case EntryType::memory_write:
      write_memory(question, decoder, member, *memory);
      break;
    default:
      answer_memory_parameter(question, decoder, member, *memory);
      break;
  }
}

void ServerEndpoint::read_memory(const Question& question, Decoder& decoder, const Member& member,
                                 MemorySource& memory) {
  const value::MemoryForm form = value::memory_form(*member.type);
  Part part;
  part.named_position = read_numbers(decoder, question.entry, "memorypos", form.is_multi);
  part.named_count = read_numbers(decoder, question.entry, "count", form.is_multi);
  place(part, memory.rr_dims(), form.is_multi);
  check_size(part, form.item->size, directory_->core()->options().limits.message_size,
             question.entry);
  channel::Charge charge = charge_part(part, form.item->size, *connection_);
  if (part.size > long_part / form.item->size) channel::Reactor::give_way();
  if (auto* const pieces = dynamic_cast<PieceMemory*>(&memory)) {
    const std::shared_ptr<const void> piece = pieces->read_piece(part.position, part.count);
    PartElements elements(part, form.is_multi, true);
    elements.add("data", pieces->piece_type(), piece.get());
    const channel::OfferedCharge offered(std::move(charge));  // drawn again if it waits to be sent
    answer_values(question, EntryType::memory_read_ret, elements.used(), elements.values.data());
    return;
  }
  value::AnyMultiArray data;
  if (form.is_multi) data.dims = short_numbers(part.named_count);
  std::byte* const items = data.items.make_room(part.size, form.item->size);
  if (part.size != 0) std::memset(items, 0, part.size * form.item->size);
  memory.rr_read(part.position, part.count, items);
  PartElements elements(part, form.is_multi, true);
  elements.add("data", *member.type, form.is_multi ? static_cast<const void*>(&data) : &data.items);
  const channel::OfferedCharge offered(std::move(charge));  // drawn again if it waits to be sent
  answer_values(question, EntryType::memory_read_ret, elements.used(), elements.values.data());
}

void ServerEndpoint::write_memory(const Question& question, Decoder& decoder, const Member& member,
                                  MemorySource& memory) {
  const value::MemoryForm form = value::memory_form(*member.type);
  Part part;
  part.named_position = read_numbers(decoder, question.entry, "memorypos", form.is_multi);
  part.named_count = read_numbers(decoder, question.entry, "count", form.is_multi);
  if (auto* const pieces = dynamic_cast<PieceMemory*>(&memory)) {
    const std::shared_ptr<void> piece = pieces->make_piece();
    endpoint::read_value(decoder, question.entry, "data", pieces->piece_type(), piece.get());
    place(part, memory.rr_dims(), form.is_multi);
    pieces->write_piece(part.position, part.count, piece.get());
    const PartElements elements(part, form.is_multi, false);
    answer_values(question, EntryType::memory_read_ret, elements.used(), elements.values.data());
    return;
  }
  value::AnyMultiArray data;
  endpoint::read_value(decoder, question.entry, "data", *member.type,
                       form.is_multi ? static_cast<void*>(&data) : &data.items);
  place(part, memory.rr_dims(), form.is_multi);
  const bool fits = form.is_multi ? std::equal(part.named_count.begin(), part.named_count.end(),
                                               data.dims.begin(), data.dims.end()) ||
                                        (part.size == 0 && data.dims.empty())
                                  : true;
  if (!fits || data.items.count() != part.size) throw outside(form.is_multi);
  memory.rr_write(part.position, part.count, data.items.items());
  const PartElements elements(part, form.is_multi, false);
  // Not memory_write_ret: clients exist that wait for this (07, section 13).
  answer_values(question, EntryType::memory_read_ret, elements.used(), elements.values.data());
}

void ServerEndpoint::answer_memory_parameter(const Question& question, Decoder& decoder,
                                             const Member& member, const MemorySource& memory) {
  const bool is_multi = value::memory_form(*member.type).is_multi;
  std::string name;
  endpoint::read_value(decoder, question.entry, "parameter", type_of<std::string>, &name);
  if (name == "MaxTransferSize") {
    const std::uint32_t limit = directory_->core()->options().memory_transfer_limit;
    answer_value(question, "return", type_of<std::uint32_t>, &limit);
  } else if (name == "Length" && !is_multi) {
    const std::uint64_t length = memory.rr_dims().at(0);
    answer_value(question, "return", type_of<std::uint64_t>, &length);
  } else if (name == "Dimensions" && is_multi) {
    const Numbers dims(memory.rr_dims());
    answer_value(question, "return", type_of<Numbers>, &dims);
  } else if (name == "DimCount" && is_multi) {
    const std::uint64_t count = memory.rr_dims().size();
    answer_value(question, "return", type_of<std::uint64_t>, &count);
  } else {
    throw Error(ErrorCode::invalid_operation, "Unknown parameter");
  }
}

}  // namespace service
}  // namespace rr
