// SPDX-License-Identifier: Apache-2.0
// Events, callbacks and memories of objects that a service offers.
#include <utility>

#include "runtime/c/src/completion.hpp"
#include "runtime/c/src/piece.hpp"
#include "runtime/c/src/served_object.hpp"
#include "runtime/cpp/src/service/piece_memory.hpp"

namespace rr::capi {
namespace {

// A member with the parameters that the program's elements are.
Member with_parameters(Member member, const Values& values) {
  member.parameters = values.parameters();
  return member;
}

std::vector<std::uint64_t> ask_dims(const rr_memory_source& source) {
  constexpr std::size_t room = 64;
  std::uint64_t dims[room] = {};
  std::size_t count = 0;
  const rr_status status = source.dims(source.context, dims, room, &count);
  if (status != RR_OK || count > room) throw Error(piece_error(status));
  return {dims, dims + count};
}

using Source = std::shared_ptr<const Handler<rr_memory_source>>;

void check(rr_status status) {
  if (status != RR_OK) throw Error(piece_error(status));
}

class NumberMemory final : public MemorySource {
 public:
  NumberMemory(Source source, std::size_t item_size)
      : source_(std::move(source)), item_size_(item_size) {}

  void rr_read(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
               void* items) override {
    const rr_memory_source& source = **source_;
    if (source.read == nullptr) throw Error(piece_error(RR_WRITE_ONLY_MEMBER));
    check(source.read(source.context, position.data(), count.data(), count.size(), items,
                      size_of(count)));
  }
  void rr_write(std::span<const std::uint64_t> position, std::span<const std::uint64_t> count,
                const void* items) override {
    const rr_memory_source& source = **source_;
    if (source.write == nullptr) throw Error(piece_error(RR_READ_ONLY_MEMBER));
    check(source.write(source.context, position.data(), count.data(), count.size(), items,
                       size_of(count)));
  }
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const override { return ask_dims(**source_); }

 private:
  // The part was found to fit into a message.
  [[nodiscard]] std::size_t size_of(std::span<const std::uint64_t> count) const {
    std::size_t size = item_size_;
    for (const std::uint64_t one : count) size *= static_cast<std::size_t>(one);
    return size;
  }

  const Source source_;
  const std::size_t item_size_;
};

class RecordMemory final : public service::PieceMemory {
 public:
  explicit RecordMemory(Source source) : source_(std::move(source)) {}

  [[nodiscard]] const Type& piece_type() const override { return raw_type; }
  std::shared_ptr<const void> read_piece(Numbers position, Numbers count) override {
    const rr_memory_source& source = **source_;
    if (source.read_piece == nullptr) throw Error(piece_error(RR_WRITE_ONLY_MEMBER));
    rr_piece piece;
    check(source.read_piece(source.context, position.data(), count.data(), count.size(), &piece));
    return std::make_shared<const Raw>(piece.take());
  }
  [[nodiscard]] std::shared_ptr<void> make_piece() const override {
    return std::make_shared<Raw>();
  }
  void write_piece(Numbers position, Numbers count, const void* piece) override {
    const rr_memory_source& source = **source_;
    if (source.write_piece == nullptr) throw Error(piece_error(RR_READ_ONLY_MEMBER));
    const rr_elements elements = static_cast<const Raw*>(piece)->data.elements();
    check(
        source.write_piece(source.context, position.data(), count.data(), count.size(), &elements));
  }
  [[nodiscard]] std::vector<std::uint64_t> rr_dims() const override { return ask_dims(**source_); }

 private:
  const Source source_;
};

std::shared_ptr<MemorySource> make_memory(const MemoryItems& items, Source source) {
  if (items.item_size() == 0) return std::make_shared<RecordMemory>(std::move(source));
  return std::make_shared<NumberMemory>(std::move(source), items.item_size());
}

}  // namespace
}  // namespace rr::capi

using rr::MemberKind;
using rr::capi::guarded;
using rr::capi::output;
using rr::capi::skeleton_of;
using rr::capi::Terms;
using rr::capi::Values;

extern "C" {

rr_status rr_served_event_fire(rr_served_object* object, uint32_t member,
                               const rr_elements* arguments, rr_error** error) {
  return guarded(error, [&] {
    const rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    const Values values(arguments);
    const rr::Member event =
        rr::capi::with_parameters(skeleton.member(member, MemberKind::event), values);
    skeleton.rr_fire(event, values.places());
  });
}

rr_status rr_served_callback_call(rr_served_object* object, uint32_t member, uint32_t client,
                                  const rr_elements* arguments, const rr_call_options* options,
                                  rr_data** out_answer, rr_error** error) {
  return guarded(error, [&] {
    output(out_answer) = nullptr;
    const rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    const Terms terms(options);
    const Values values(arguments);
    const rr::Member callback =
        rr::capi::with_parameters(skeleton.member(member, MemberKind::callback), values);
    rr::capi::Raw answer;
    skeleton.rr_ask_client(callback, client, values.places(), &answer);
    *out_answer = std::move(answer.data).hand_out();
  });
}

rr_status rr_served_callback_call_async(rr_served_object* object, uint32_t member, uint32_t client,
                                        const rr_elements* arguments,
                                        const rr_call_options* options,
                                        const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    const Terms terms(options);
    const Values values(arguments);
    // Needed until the answer is read, but for the parameters.
    const auto callback = std::make_shared<const rr::Member>(
        rr::capi::with_parameters(skeleton.member(member, MemberKind::callback), values));
    skeleton.rr_start_asking(
        *callback, client, values.places(),
        rr::capi::complete<rr::capi::Raw>(
            completion, [callback, type = skeleton.type()](rr::capi::Raw& answer) -> void* {
              return std::move(answer.data).hand_out();
            }));
  });
}

rr_status rr_served_memory_set(rr_served_object* object, uint32_t member,
                               const rr_memory_source* source, rr_error** error) {
  return guarded(error, [&] {
    auto functions = rr::capi::take_handler(source, &rr_memory_source::dims);
    rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    static_cast<void>(skeleton.member(member, MemberKind::memory));
    skeleton.set_memory(
        member, rr::capi::make_memory(skeleton.type()->memory(member), std::move(functions)));
  });
}

}  // extern "C"
