// SPDX-License-Identifier: Apache-2.0
// The client's side of memories.
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "rr/call.hpp"
#include "rr/error.hpp"
#include "rr/memories.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/client/memory_transfer.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"

namespace rr {
namespace {

using client::MemoryTransfer;
using Numbers = MemoryTransfer::Numbers;

Session& session_of(const Stub& stub) {
  if (!stub.rr_session()) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  return *stub.rr_session();
}

// For a member that this program and the service know alike.
Session& session_of(const Stub& stub, const Member& member) {
  Session& session = session_of(stub);
  session.check_member(stub, member);
  return session;
}

void ask(const Stub& stub, const Member& member, std::string name, const Type& type, void* value) {
  const Parameter parameter{"parameter", &type_of<std::string>};
  const void* const place = &name;
  session_of(stub, member)
      .call({EntryType::memory_get_param, stub.rr_path(), member.name, {&parameter, 1}, &place},
            Incoming{"return", &type, value}, stub.rr_timeout());
}

void transfer(const Stub& stub, const Member& member, MemoryTransfer::Direction direction,
              Numbers position, Numbers count, std::byte* items, std::size_t size) {
  Session& session = session_of(stub, member);
  MemoryTransfer transfer(stub.rr_path(), member, direction, position, count, items, size,
                          session.memory_transfer_limit());
  const Session::AnswerReader read = [&transfer](Decoder& decoder, const Message&,
                                                 const Entry& entry) {
    transfer.take(decoder, entry);
  };
  while (!transfer.is_done()) {
    std::uint32_t limit = 0;
    session.call(transfer.question(), Incoming{"return", &type_of<std::uint32_t>, &limit},
                 stub.rr_timeout());
    if (!transfer.fits(limit)) continue;
    session.call(transfer.request(), read, stub.rr_timeout());
    transfer.advance();
  }
}

// A transfer that nobody waits for. One request is open at a time; each ends here.
class AsyncTransfer final : public Completion, public std::enable_shared_from_this<AsyncTransfer> {
 public:
  AsyncTransfer(const Stub& stub, const Member& member, MemoryTransfer::Direction direction,
                Numbers position, Numbers count, std::byte* items, std::size_t size,
                MemoryRef owner, std::unique_ptr<Completion> completion)
      : session_(session_of(stub).shared_from_this()),
        timeout_(stub.rr_timeout()),
        terms_(CallTerms::of_started_call()),
        owner_(std::move(owner)),
        completion_(std::move(completion)),
        transfer_(stub.rr_path(), member, direction, position, count, items, size,
                  session_->memory_transfer_limit()) {}

  void go_on() {
    // As if the thread that began the transfer made all its calls.
    const CallOptionsScope scope(terms_);
    if (is_asking_) {
      session_->start(transfer_.question(), {"return", &type_of<std::uint32_t>, &limit_}, timeout_,
                      shared_from_this());
      return;
    }
    session_->start(
        transfer_.request(),
        [self = shared_from_this()](Decoder& decoder, const Message&, const Entry& entry) {
          self->transfer_.take(decoder, entry);
        },
        timeout_, shared_from_this());
  }

  void* result() override { return nullptr; }
  void succeed() override {
    if (is_asking_) {
      is_asking_ = !transfer_.fits(limit_);
    } else {
      transfer_.advance();
      is_asking_ = true;
    }
    if (transfer_.is_done()) {
      completion_->succeed();
    } else {
      go_on();
    }
  }
  void fail(std::exception_ptr error) override { completion_->fail(std::move(error)); }

 private:
  const std::shared_ptr<Session> session_;
  const std::chrono::milliseconds timeout_;
  const CallTerms terms_;
  const MemoryRef owner_;
  const std::unique_ptr<Completion> completion_;
  MemoryTransfer transfer_;
  std::uint32_t limit_ = 0;
  bool is_asking_ = true;
};

}  // namespace

std::uint64_t MemoryMember::ask_length() const {
  std::uint64_t length = 0;
  ask(*stub_, *member_, "Length", type_of<std::uint64_t>, &length);
  return length;
}

std::vector<std::uint64_t> MemoryMember::ask_dims() const {
  Array<std::uint64_t> dims;
  ask(*stub_, *member_, "Dimensions", type_of<Array<std::uint64_t>>, &dims);
  return {dims.begin(), dims.end()};
}

std::uint64_t MemoryMember::ask_dim_count() const {
  std::uint64_t count = 0;
  ask(*stub_, *member_, "DimCount", type_of<std::uint64_t>, &count);
  return count;
}

void MemoryMember::read_part(Numbers position, Numbers count, void* items, std::size_t size) const {
  transfer(*stub_, *member_, MemoryTransfer::Direction::read, position, count,
           static_cast<std::byte*>(items), size);
}

void MemoryMember::write_part(Numbers position, Numbers count, const void* items,
                              std::size_t size) const {
  transfer(*stub_, *member_, MemoryTransfer::Direction::write, position, count,
           static_cast<std::byte*>(const_cast<void*>(items)), size);
}

void MemoryMember::start_read(Numbers position, Numbers count, void* items, std::size_t size,
                              std::unique_ptr<Completion> completion) const {
  if (session_of(*stub_).refuse_start(*stub_, *member_, completion)) return;
  std::make_shared<AsyncTransfer>(*stub_, *member_, MemoryTransfer::Direction::read, position,
                                  count, static_cast<std::byte*>(items), size, MemoryRef(),
                                  std::move(completion))
      ->go_on();
}

void MemoryMember::start_write(Numbers position, Numbers count, const void* items, std::size_t size,
                               MemoryRef owner, std::unique_ptr<Completion> completion) const {
  if (session_of(*stub_).refuse_start(*stub_, *member_, completion)) return;
  std::make_shared<AsyncTransfer>(*stub_, *member_, MemoryTransfer::Direction::write, position,
                                  count, static_cast<std::byte*>(const_cast<void*>(items)), size,
                                  std::move(owner), std::move(completion))
      ->go_on();
}

std::size_t MemoryMember::size_of(Numbers count) {
  std::size_t size = 1;
  for (const std::uint64_t one : count) {
    if (one != 0 && size > std::numeric_limits<std::uint32_t>::max() / one) {
      throw Error(ErrorCode::invalid_argument, "no array holds so many items");
    }
    size *= static_cast<std::size_t>(one);
  }
  return size;
}

}  // namespace rr
