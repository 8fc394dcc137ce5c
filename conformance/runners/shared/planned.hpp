// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <rr/callbacks.hpp>
#include <rr/generators.hpp>
#include <rr/memories.hpp>
#include <rr/pipes.hpp>
#include <rr/wires.hpp>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "conformance/runners/shared/adapters.hpp"

/// What a plan does with members that live longer than a call, whatever their types are.
namespace rr::conformance {

/// Takes what arrives by itself: {packet: value}, {ack: number}, {value: value}, {closed: true}.
using Arrive = std::function<void(Json)>;

/// A connected pipe endpoint.
class PlannedPipe {
 public:
  virtual ~PlannedPipe() = default;
  [[nodiscard]] virtual Json index() const = 0;
  /// The packet's number; null where packets may be lost.
  virtual Json send(const Json& packet, bool acknowledged) = 0;
  virtual void close() = 0;
};

/// A wire; the last three need it to be connected.
class PlannedWire {
 public:
  virtual ~PlannedWire() = default;
  virtual Json peek_in() = 0;
  virtual Json peek_out() = 0;
  virtual void poke_out(const Json& value) = 0;
  virtual void connect(Arrive arrive) = 0;
  virtual Json in() = 0;
  virtual void set_out(const Json& value) = 0;
  virtual void close() = 0;
};

/// A generator that was called.
class PlannedGenerator {
 public:
  virtual ~PlannedGenerator() = default;
  /// `parameter` is null where none is taken; the result is where none is given. The end throws
  /// rr::Error (stop_iteration).
  virtual Json next(const Json& parameter) = 0;
  virtual void close() = 0;
  virtual void abort() = 0;
};

class PlannedMemory {
 public:
  virtual ~PlannedMemory() = default;
  virtual Json length() = 0;
  virtual Json dims() = 0;
  virtual Json dim_count() = 0;
  /// Positions and counts are a number, or a list of them.
  virtual Json read(const Json& position, const Json& count) = 0;
  virtual void write(const Json& position, const Json& count, const Json& value) = 0;
};

// An end that the plan closes itself has nothing to say about it.
template <class End>
void report_closing(End& end, const std::shared_ptr<std::atomic<bool>>& is_own,
                    const Arrive& arrive) {
  end.on_closed([is_own, arrive] {
    if (!*is_own) arrive({{"closed", true}});
  });
}

template <class T>
class TypedPipe final : public PlannedPipe {
 public:
  TypedPipe(const Adapters& adapters, PipeEndpoint<T> end, const Arrive& arrive)
      : adapters_(adapters), end_(std::move(end)) {
    report_closing(end_, is_closing_, arrive);
    end_.on_acknowledged([arrive](std::uint32_t number) { arrive({{"ack", number}}); });
    packets_ = end_.on_packet([&adapters, arrive](const T& packet) {
      arrive({{"packet", to_json<T>(adapters, packet)}});
    });
  }

  [[nodiscard]] Json index() const override { return end_.index(); }
  Json send(const Json& packet, bool acknowledged) override {
    end_.ask_for_acknowledgements(acknowledged);
    const std::uint32_t number = end_.send(made_from_json<T>(adapters_, packet));
    return end_.is_unreliable() ? Json() : Json(number);
  }
  void close() override {
    *is_closing_ = true;
    end_.close();
  }

 private:
  const Adapters& adapters_;
  PipeEndpoint<T> end_;
  std::shared_ptr<std::atomic<bool>> is_closing_ = std::make_shared<std::atomic<bool>>(false);
  Subscription packets_;
};

template <class T>
class TypedWire final : public PlannedWire {
 public:
  TypedWire(const Adapters& adapters, Wire<T> wire) : adapters_(adapters), wire_(wire) {}

  Json peek_in() override { return to_json<T>(adapters_, wire_.peek_in().value); }
  Json peek_out() override { return to_json<T>(adapters_, wire_.peek_out().value); }
  void poke_out(const Json& value) override { wire_.poke_out(made_from_json<T>(adapters_, value)); }
  void connect(Arrive arrive) override {
    end_ = wire_.connect();
    report_closing(end_, is_closing_, arrive);
    values_ = end_.on_in([&adapters = adapters_, arrive](const T& value, const TimeSpec&) {
      arrive({{"value", to_json<T>(adapters, value)}});
    });
  }
  Json in() override { return to_json<T>(adapters_, end_.in()); }
  void set_out(const Json& value) override { end_.set_out(made_from_json<T>(adapters_, value)); }
  void close() override {
    *is_closing_ = true;
    end_.close();
  }

 private:
  const Adapters& adapters_;
  Wire<T> wire_;
  WireConnection<T> end_;
  std::shared_ptr<std::atomic<bool>> is_closing_ = std::make_shared<std::atomic<bool>>(false);
  Subscription values_;
};

/// A memory of one dimension, or of several; the plan spells positions accordingly.
template <class Memory>
class TypedMemory;

template <class T>
class TypedMemory<ArrayMemory<T>> final : public PlannedMemory {
 public:
  TypedMemory(const Adapters& adapters, ArrayMemory<T> memory)
      : adapters_(adapters), memory_(memory) {}

  Json length() override { return to_json(adapters_, memory_.length()); }
  Json dims() override { return Json::array({length()}); }
  Json dim_count() override { return "1"; }
  Json read(const Json& position, const Json& count) override {
    const auto at = position.get<std::uint64_t>();
    return to_json(adapters_, memory_.read(at, count.get<std::uint64_t>()));
  }
  void write(const Json& position, const Json& count, const Json& value) override {
    const auto items = made_from_json<Array<T>>(adapters_, value);
    memory_.write(position.get<std::uint64_t>(),
                  std::span<const T>(items).first(count.get<std::size_t>()));
  }

 private:
  const Adapters& adapters_;
  ArrayMemory<T> memory_;
};

template <class T>
class TypedMemory<MultiMemory<T>> final : public PlannedMemory {
 public:
  TypedMemory(const Adapters& adapters, MultiMemory<T> memory)
      : adapters_(adapters), memory_(memory) {}

  Json length() override { throw Error(ErrorCode::invalid_operation, "It has dimensions"); }
  Json dims() override { return to_json(adapters_, memory_.dims()); }
  Json dim_count() override { return to_json(adapters_, memory_.dim_count()); }
  Json read(const Json& position, const Json& count) override {
    const auto at = position.get<Numbers>();
    const auto shape = count.get<Numbers>();
    return to_json<MultiArray<T>>(adapters_, memory_.read(at, shape));
  }
  void write(const Json& position, const Json& count, const Json& value) override {
    const auto at = position.get<Numbers>();
    const auto shape = count.get<Numbers>();
    const auto array = made_from_json<MultiArray<T>>(adapters_, value);
    memory_.write(at, shape, array.items);
  }

 private:
  using Numbers = std::vector<std::uint64_t>;
  const Adapters& adapters_;
  MultiMemory<T> memory_;
};

template <class R, class P>
class TypedGenerator final : public PlannedGenerator {
 public:
  TypedGenerator(const Adapters& adapters, Generator<R, P> generator)
      : adapters_(adapters), generator_(std::move(generator)) {}

  Json next(const Json& parameter) override {
    const auto result = step(parameter);
    if (!result) throw Error(ErrorCode::stop_iteration, "");
    if constexpr (std::is_void_v<R>) {
      return nullptr;
    } else {
      return to_json<R>(adapters_, *result);
    }
  }
  void close() override { generator_.close(); }
  void abort() override { generator_.abort(); }

 private:
  auto step([[maybe_unused]] const Json& parameter) {
    if constexpr (std::is_void_v<P>) {
      return generator_.next();
    } else {
      return generator_.next(made_from_json<P>(adapters_, parameter));
    }
  }

  const Adapters& adapters_;
  Generator<R, P> generator_;
};

}  // namespace rr::conformance
