// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/pipes.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/client/pipe_end.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"
#include "runtime/cpp/src/endpoint/ring_terms.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr::client {
namespace {

constexpr std::chrono::milliseconds close_limit{500};  // 07, section 7
// Packets that come before their endpoint is known.
constexpr std::size_t early_packets = 1024;
constexpr std::size_t early_bytes = std::size_t{16} * 1024 * 1024;
// What a packet that waits costs besides its value.
constexpr std::size_t bytes_beside_packet = 128;

constexpr Parameter index_parameter = parameter<std::int32_t>("index");

// The elements of a request to connect.
class ConnectRequest {
 public:
  ConnectRequest(const Pipes::Wish& wish, const channel::Connection& connection)
      : index_(wish.options.index),
        request_{EntryType::pipe_connect_req, wish.path, wish.member->name} {
    add(parameter<std::int32_t>("index"), &index_);
    if (wish.options.unreliable && (wish.member->access & unreliable) != 0) {
      add(parameter<std::int32_t>("unreliable"), &is_unreliable_);
    }
    if (ClientPipeEnd::wish(connection, *wish.member) == endpoint::RingWish::ring) {
      add({endpoint::ring_element, &type_of<std::uint32_t>}, &ring_);
    }
    request_.parameters = std::span(parameters_.data(), count_);
    request_.values = values_.data();
  }
  ConnectRequest(const ConnectRequest&) = delete;
  ConnectRequest& operator=(const ConnectRequest&) = delete;
  operator const Outgoing&() const { return request_; }  // NOLINT

 private:
  static constexpr std::size_t most = 3;

  void add(const Parameter& parameter, const void* value) {
    parameters_[count_] = parameter;
    values_[count_++] = value;
  }

  const std::int32_t index_;
  const std::int32_t is_unreliable_ = 1;
  const std::uint32_t ring_ = static_cast<std::uint32_t>(endpoint::RingWish::ring);
  std::size_t count_ = 0;
  std::array<Parameter, most> parameters_{};
  std::array<const void*, most> values_{};
  Outgoing request_;
};

// Of an answer that nobody cares about.
class Ignored final : public Completion {
 public:
  void* result() override { return nullptr; }
  void succeed() override {}
  void fail(std::exception_ptr /*error*/) override {}
};

}  // namespace

// A request to connect that is open: packets that come meanwhile are kept.
class Pipes::Connecting {
 public:
  Connecting(Pipes& pipes, Wish what) : pipes_(pipes), wish(std::move(what)) { pipes_.begin(wish); }
  ~Connecting() { pipes_.finish(wish); }
  Connecting(const Connecting&) = delete;
  Connecting& operator=(const Connecting&) = delete;

  void read(Decoder& decoder, const Entry& entry) { end = pipes_.open(wish, decoder, entry); }

 private:
  Pipes& pipes_;

 public:
  const Wish wish;
  End end;
};

// The same, with who waits for it.
class Pipes::Opened final : public Completion {
 public:
  Opened(std::shared_ptr<Connecting> connecting, std::unique_ptr<Completion> completion)
      : connecting_(std::move(connecting)), completion_(std::move(completion)) {}
  void* result() override { return nullptr; }
  void succeed() override {
    *static_cast<PipeEnd*>(completion_->result()) = PipeEnd(connecting_->end);
    completion_->succeed();
  }
  void fail(std::exception_ptr error) override { completion_->fail(std::move(error)); }

 private:
  const std::shared_ptr<Connecting> connecting_;
  const std::unique_ptr<Completion> completion_;
};

PipeEnd Pipes::connect(Wish wish, std::chrono::milliseconds timeout) {
  Connecting connecting(*this, std::move(wish));
  session_.call(
      ConnectRequest(connecting.wish, connection()),
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        connecting.read(decoder, entry);
      },
      timeout);
  return PipeEnd(connecting.end);
}

void Pipes::start_connect(Wish wish, std::chrono::milliseconds timeout,
                          std::unique_ptr<Completion> completion) {
  const auto connecting = std::make_shared<Connecting>(*this, std::move(wish));
  session_.start(
      ConnectRequest(connecting->wish, connection()),
      [connecting](Decoder& decoder, const Message&, const Entry& entry) {
        connecting->read(decoder, entry);
      },
      timeout, std::make_shared<Opened>(connecting, std::move(completion)));
}

// Asks to close an endpoint that there is not: a lock is looked at first (07, section 6).
void Pipes::start_lock_check(const std::string& path, const Member& member,
                             std::chrono::milliseconds timeout,
                             std::unique_ptr<Completion> completion) {
  const std::int32_t index = PipeOptions().index;  // of no endpoint
  const void* const values[] = {&index};
  session_.start({EntryType::pipe_disconnect_req, path, member.name, {&index_parameter, 1}, values},
                 Incoming{}, timeout, std::move(completion));
}

void Pipes::begin(const Wish& wish) {
  const MutexLock lock(mutex_);
  Early& early = early_[Key(wish.path, wish.member->name)];
  early.member = wish.member;
  early.holding = wish.holding;
  if (early.connecting++ == 0) early.charge = channel::Charge(connection().account());
}

void Pipes::finish(const Wish& wish) {
  std::deque<Early::Packet> unclaimed;
  const MutexLock lock(mutex_);
  const auto early = early_.find(Key(wish.path, wish.member->name));
  if (--early->second.connecting != 0) return;
  unclaimed.swap(early->second.packets);
  early_.erase(early);
}

// From the answer, on whichever thread has read it.
Pipes::End Pipes::open(const Wish& wish, Decoder& decoder, const Entry& entry) {
  std::int32_t index = 0;
  endpoint::read_value(decoder, entry, "index", type_of<std::int32_t>, &index);
  Element element;
  const bool is_unreliable =
      wish.options.unreliable && (wish.member->access & unreliable) != 0 &&
      find_element(decoder, entry.elements, entry.element_count, "unreliable", element);
  const auto end = std::make_shared<ClientPipeEnd>(
      session_.core(), std::shared_ptr<endpoint::PipeSide>(session_.shared_from_this(), this),
      PipeEnd::State::Identity{wish.path, wish.member, wish.holding, index, is_unreliable, true},
      session_.notices().read());
  end->take_answer(decoder, entry);
  bool has_room = true;
  End predecessor;
  {
    const MutexLock lock(mutex_);
    predecessor = add(end);
    Early& early = early_[Key(wish.path, wish.member->name)];
    std::erase_if(early.packets, [&](Early::Packet& packet) {
      if (packet.index != index) return false;
      early.charge.reduce(packet.size + bytes_beside_packet);
      has_room = end->accept(packet.number, std::move(packet.value), packet.size) && has_room;
      return true;
    });
  }
  channel::DeferredCallbacks later;
  if (predecessor) later.emplace_back([predecessor] { predecessor->finish(); });
  if (!has_room) {
    later.emplace_back([end] {
      if (const auto side = end->side()) side->close(*end, false);
    });
  }
  if (!later.empty()) session_.post(std::move(later));
  return end;
}

// Returns the end whose index the new one has been given; null: none.
Pipes::End Pipes::add(const End& end) {
  if (ends_.add(end)) return nullptr;
  const PipeEnd::State::Identity& what = end->identity;
  End predecessor = ends_.find(what.path, what.member->name, what.index);
  ends_.remove(*predecessor);
  ends_.add(end);
  return predecessor;
}

// Whether the end has been connected after the service has sent a notice.
bool Pipes::is_overtaken(const End& end, std::uint64_t notice) {
  return static_cast<const ClientPipeEnd&>(*end).notices_before >= notice;
}

bool Pipes::keep_early(const Entry& entry, const endpoint::PipePacket& packet, Decoder& decoder) {
  const auto found = early_.find(Key(entry.service_path, entry.member));
  if (found == early_.end()) return false;
  Early& early = found->second;
  const std::size_t size = packet.size + bytes_beside_packet;
  const bool is_full = early.packets.size() >= early_packets ||
                       early.charge.bytes() + size > early_bytes || !early.charge.add(size);
  if (is_full) return false;
  Early::Packet kept{packet.index, packet.number, early.holding->make(), packet.size};
  Decoder reader(decoder.version(), decoder.strings(), decoder.owner(), decoder.types());
  if (!early.member->type->read(reader, packet.value, kept.value.get())) {
    early.charge.reduce(size);
    return false;
  }
  early.packets.push_back(std::move(kept));
  return true;
}

[[gnu::hot]] void Pipes::take_packets(const Message& message, const Entry& entry,
                                      const MemoryRef& owner) {
  const bool may_have_rings = connection().shares_slots();
  if (may_have_rings && take_ring_notice(message, entry)) return;
  endpoint::PipeArrival arrival(message, entry, owner, *session_.types(), {});
  End last;
  std::vector<End> others;  // rarely, more than one has packets in an entry
  arrival.take(
      [&](const endpoint::PipePacket& packet, Decoder& decoder) -> endpoint::PipeArrival::Taken {
        const MutexLock lock(mutex_);
        if (auto end = ends_.find(entry.service_path, entry.member, packet.index)) {
          if (may_have_rings) {
            if (last && last != end) others.push_back(std::move(last));
            last = end;
          }
          return {std::move(end), true};
        }
        return {nullptr, keep_early(entry, packet, decoder)};
      });
  if (arrival.has_acknowledgements()) {
    Writer& writer = channel::thread_writer();
    writer.reset(connection().version());
    const std::uint32_t count = arrival.write_acknowledgements(writer);
    session_.reply_packet(writer,
                          {.type = EntryType::pipe_packet_ret,
                           .service_path = entry.service_path,
                           .member = entry.member},
                          count, arrival.metadata());
  }
  arrival.deliver();
  if (!last) return;
  static_cast<ClientPipeEnd&>(*last).note_packet();
  for (const End& end : others) static_cast<ClientPipeEnd&>(*end).note_packet();
}

// False when the entry has packets.
bool Pipes::take_ring_notice(const Message& message, const Entry& entry) {
  Decoder decoder(message.version, &message.strings);
  const auto notice = endpoint::find_ring_notice(decoder, entry);
  if (!notice) return false;
  End end;
  {
    const MutexLock lock(mutex_);
    end = ends_.find(entry.service_path, entry.member, *notice);
  }
  if (end) static_cast<ClientPipeEnd&>(*end).take_notice();
  return true;
}

void Pipes::take_acknowledgements(const Message& message, const Entry& entry) {
  if (entry.error != 0) return;  // a packet to what is not there
  endpoint::for_each_acknowledgement(message, entry, [&](std::int32_t index, std::uint32_t number) {
    End end;
    {
      const MutexLock lock(mutex_);
      end = ends_.find(entry.service_path, entry.member, index);
    }
    if (end) end->take_acknowledgement(number);
  });
}

void Pipes::take_closed(const Message& message, const Entry& entry, std::uint64_t notice) {
  Decoder decoder(message.version, &message.strings);
  std::int32_t index = 0;
  endpoint::read_value(decoder, entry, "index", type_of<std::int32_t>, &index);
  End end;
  {
    const MutexLock lock(mutex_);
    end = ends_.find(entry.service_path, entry.member, index);
    if (!end || is_overtaken(end, notice)) return;
    ends_.remove(*end);
  }
  end_now(*end);
}

// What is in a ring for it has been sent before it ended.
void Pipes::end_now(PipeEnd::State& end) {
  static_cast<ClientPipeEnd&>(end).take_rest();
  end.finish();
}

void Pipes::release(std::string_view path, std::uint64_t notice) {
  std::vector<End> ended;
  {
    const MutexLock lock(mutex_);
    ended = ends_.take_below(path);
    std::erase_if(ended, [&](const End& end) RR_REQUIRES(mutex_) {
      return is_overtaken(end, notice) && ends_.add(end);
    });
  }
  for (const End& end : ended) end_now(*end);
}

void Pipes::end() {
  std::vector<End> ended;
  {
    const MutexLock lock(mutex_);
    ended = ends_.take_all();
  }
  for (const End& end : ended) end_now(*end);
}

channel::Connection& Pipes::connection() const { return session_.connection(); }
std::shared_ptr<const TypeRegistry> Pipes::types() const { return session_.types(); }

[[gnu::hot]] void Pipes::stream(Writer& writer, const EntryHeader& header,
                                std::string_view metadata) {
  session_.stream_packet(writer, header, metadata);
}

void Pipes::close(PipeEnd::State& end, bool may_wait) {
  {
    const MutexLock lock(mutex_);
    if (!ends_.remove(end)) return;
  }
  const auto keep = session_.shared_from_this();
  static_cast<ClientPipeEnd&>(end).stop_reading();
  end.finish();
  const std::int32_t index = end.identity.index;
  const void* const values[] = {&index};
  const Outgoing request{EntryType::pipe_disconnect_req,
                         end.identity.path,
                         end.identity.member->name,
                         {&index_parameter, 1},
                         values};
  if (!may_wait) {
    session_.start(request, Incoming{}, close_limit, std::make_shared<Ignored>());
    return;
  }
  try {
    session_.call(request, Incoming{}, close_limit);
  } catch (const Error&) {
    // Whatever the service says, it is closed here.
  }
}

}  // namespace rr::client

namespace rr {
namespace {

Session& need(const Stub& stub) {
  if (!stub.rr_session()) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  return *stub.rr_session();
}

}  // namespace

PipeEnd PipeMember::connect_end(const PipeOptions& options) {
  Session& session = need(*stub_);
  session.check_member(*stub_, *member_);
  return session.pipes().connect({stub_->rr_path(), member_, holding_, options},
                                 stub_->rr_timeout());
}

void PipeMember::start_connect(const PipeOptions& options, std::unique_ptr<Completion> completion) {
  Session& session = need(*stub_);
  if (session.refuse_start(*stub_, *member_, completion)) return;
  session.pipes().start_connect({stub_->rr_path(), member_, holding_, options}, stub_->rr_timeout(),
                                std::move(completion));
}

void PipeMember::start_lock_check(std::unique_ptr<Completion> completion) {
  Session& session = need(*stub_);
  if (session.refuse_start(*stub_, *member_, completion)) return;
  session.pipes().start_lock_check(stub_->rr_path(), *member_, stub_->rr_timeout(),
                                   std::move(completion));
}

}  // namespace rr
