// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rr/callbacks.hpp"
#include "rr/generators.hpp"
#include "rr/node.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"

/// An object with callbacks and generators, as the compiler would generate it.
namespace rr::testing {

struct Note {
  std::string text;
  Array<double> numbers;
  bool operator==(const Note&) const = default;
};

/// `exception Jam`
class Jam : public Error {
 public:
  explicit Jam(std::string message, std::string subname = {}, const VarValue& parameter = {})
      : Error(ErrorCode::remote_error, "test.board.Jam", std::move(message), std::move(subname),
              parameter) {}
  explicit Jam(const Error& error) : Error(error) {}
};

extern const RecordType rr_Note;
extern const Definition rr_board_definition;
extern const ObjectType rr_Board;

enum BoardPlace : std::size_t {
  ping_place,
  sum_place,
  describe_place,
  fail_place,
  run_place,
  count_to_place,
  names_place,
  notes_place,
  collect_place,
  running_sum_place,
  note_down_place,
  board_child_place,
};

class BoardStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Board; }

  Callback<void()> ping() { return {*this, member(ping_place)}; }
  Callback<std::int32_t(std::int32_t, std::int32_t)> sum() { return {*this, member(sum_place)}; }
  Callback<std::optional<Note>(std::string, Array<double>)> describe() {
    return {*this, member(describe_place)};
  }
  Callback<double(std::string)> fail() { return {*this, member(fail_place)}; }

  double run(const std::string& what) { return rr_call<double>(member(run_place), {}, what); }
  Generator<std::int32_t> count_to(std::int32_t limit) {
    return rr_generate<std::int32_t, void>(member(count_to_place), {}, limit);
  }
  Generator<std::string> names(const std::string& label) {
    return rr_generate<std::string, void>(member(names_place), {}, label);
  }
  Generator<std::optional<Note>> notes() {
    return rr_generate<std::optional<Note>, void>(member(notes_place), {});
  }
  Generator<void, double> collect(const std::string& label) {
    return rr_generate<void, double>(member(collect_place), {}, label);
  }
  Generator<double, double> running_sum(double start) {
    return rr_generate<double, double>(member(running_sum_place), {}, start);
  }
  std::shared_ptr<BoardStub> get_child() {
    return rr_find_as<BoardStub>(member(board_child_place), {});
  }
  Event<std::string>& note_down() { return note_down_; }

  // The asynchronous forms.
  template <class Token>
  auto async_run(const std::string& what, Token&& token) {
    return rr_async_call<double>(member(run_place), {}, std::forward<Token>(token), what);
  }
  template <class Token>
  auto async_count_to(std::int32_t limit, Token&& token) {
    return rr_async_generate<std::int32_t, void>(member(count_to_place), {},
                                                 std::forward<Token>(token), limit);
  }

 private:
  static const Member& member(std::size_t place) { return rr_Board.members[place]; }
  Event<std::string> note_down_{*this, member(note_down_place)};
};

class BoardSkeleton : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Board; }
  void rr_dispatch(std::size_t place, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t place, const ObjectIndex& index) override;

  void ping(std::uint32_t client) const { rr_call_back<void>(member(ping_place), {}, client); }
  std::int32_t sum(std::uint32_t client, std::int32_t a, std::int32_t b) const {
    return rr_call_back<std::int32_t>(member(sum_place), {}, client, a, b);
  }
  std::optional<Note> describe(std::uint32_t client, const std::string& text,
                               const Array<double>& numbers) const {
    return rr_call_back<std::optional<Note>>(member(describe_place), {}, client, text, numbers);
  }
  double fail(std::uint32_t client, const std::string& text) const {
    return rr_call_back<double>(member(fail_place), {}, client, text);
  }
  /// A callback that the definition does not have.
  void stray(std::uint32_t client) const;
  template <class Token>
  auto async_sum(std::uint32_t client, std::int32_t a, std::int32_t b, Token&& token) const {
    return rr_async_call_back<std::int32_t>(member(sum_place), {}, std::forward<Token>(token),
                                            client, a, b);
  }
  template <class Token>
  auto async_ping(std::uint32_t client, const CallOptions& options, Token&& token) const {
    return rr_async_call_back<void>(member(ping_place), options, std::forward<Token>(token),
                                    client);
  }
  template <class Token>
  auto async_ping(std::uint32_t client, Token&& token) const {
    return async_ping(client, CallOptions(), std::forward<Token>(token));
  }
  void note_down(const std::string& text) const { rr_fire_event(member(note_down_place), text); }

  virtual double run(const std::string& what) = 0;
  virtual Sequence<std::int32_t> count_to(std::int32_t limit) = 0;
  virtual Sequence<std::string> names(std::string label) = 0;
  virtual Sequence<std::optional<Note>> notes() = 0;
  virtual Sequence<void, double> collect(std::string label) = 0;
  virtual Sequence<double, double> running_sum(double start) = 0;
  virtual std::shared_ptr<Skeleton> get_child() = 0;

 private:
  static const Member& member(std::size_t place) { return rr_Board.members[place]; }
};

/// A board whose tests say what it does.
class Board : public BoardSkeleton {
 public:
  double run(const std::string& what) override { return on_run ? on_run(what) : 0; }
  Sequence<std::int32_t> count_to(std::int32_t limit) override;
  Sequence<std::string> names(std::string label) override;
  Sequence<std::optional<Note>> notes() override;
  Sequence<void, double> collect(std::string label) override;
  Sequence<double, double> running_sum(double start) override;
  std::shared_ptr<Skeleton> get_child() override { return std::make_shared<Board>(); }

  std::function<double(const std::string&)> on_run;
  /// Instead of what count_to() does by itself.
  std::function<Sequence<std::int32_t>(std::int32_t)> on_count_to;
  std::function<void(std::int32_t)> on_step;  ///< in each step of count_to()
  std::shared_ptr<void> held;  ///< by each coroutine of count_to() until it goes away
  std::function<void(const std::string&, double)> on_collect;
};

/// A node that offers a board, and another that can connect to it, on the loopback interface.
struct BoardPair {
  explicit BoardPair(NodeOptions server_options = {}, NodeOptions client_options = {})
      : server(std::move(server_options)), client(std::move(client_options)) {
    service = server.register_service("board", object);
    port = server.listen_tcp(0, "127.0.0.1");
  }
  Client<BoardStub> connect() {
    return client.connect<BoardStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                     "/?service=board");
  }
  /// The number of the client that is the only one.
  [[nodiscard]] std::uint32_t only_client() const { return service->clients().at(0).endpoint; }

  std::shared_ptr<Board> object = std::make_shared<Board>();
  Node server;
  Node client;
  Service service;
  std::uint16_t port = 0;
};

}  // namespace rr::testing

template <>
inline constexpr const rr::Type& rr::type_of<rr::testing::Note> = rr::testing::rr_Note;
