// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "rr/mutex.hpp"
#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/serial.hpp"
#include "rr/skeleton.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"
#include "runtime/cpp/src/serial/board.hpp"
#include "runtime/cpp/src/serial/refusals.hpp"

/// A board as a service: its definition's tables are made when the board is met, and each request
/// of a client becomes one of the serial protocol.
namespace rr::serial {

class BoardObject;

/// A definition that a board serves, and its objects.
class BoardService : public std::enable_shared_from_this<BoardService> {
 public:
  using Log = std::function<void(const std::string&)>;

  /// `log` is notified of refusals that no client waits for. Throws rr::Error
  /// (service_definition_error).
  BoardService(std::shared_ptr<Board> board, const BoardTexts& texts, Node& node, Log log);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::shared_ptr<BoardObject> root();
  /// The object of this number, made when it is met first.
  std::shared_ptr<BoardObject> object(std::uint8_t number, const std::string& type);
  void handle(const Unasked& one);
  /// Opens again what clients want, in a new session.
  void open_again();
  /// The board goes: nothing is asked of it any more.
  void detach();

  // For the objects.
  void ask(Kind kind, std::vector<std::uint8_t> body, Board::Done done, std::uint32_t client = 0);
  Outcome ask(Kind kind, std::vector<std::uint8_t> body);
  void set_wire(std::vector<std::uint8_t> body, Board::Done done);
  void open(std::uint8_t object, std::uint8_t member, bool opens);
  [[nodiscard]] std::uint32_t client_of(std::uint8_t sequence);
  /// What the client gets whose request for this member did not succeed.
  [[nodiscard]] Error error_of(std::string_view member, const Outcome& outcome) const {
    return refusal_of(member, outcome, exceptions_);
  }
  [[nodiscard]] const std::vector<std::string>& exceptions() const { return exceptions_; }
  /// Of what nobody waits for: a packet, a value of a wire, the answer to a callback. Said once
  /// while it stays so.
  void report_lost(const std::string& what, std::string_view member, const Outcome& outcome);
  [[nodiscard]] Node& node() { return node_; }

 private:
  Mutex mutex_;
  std::shared_ptr<Board> board_ RR_GUARDED_BY(mutex_);  ///< null when it has gone
  Node& node_;
  std::shared_ptr<dynamic::Tables> tables_;
  std::string name_;
  std::string root_type_;
  std::vector<std::string> exceptions_;  ///< qualified, in the order of the definition
  std::map<std::uint8_t, std::shared_ptr<BoardObject>> objects_ RR_GUARDED_BY(mutex_);
  std::set<std::pair<std::uint8_t, std::uint8_t>> open_ RR_GUARDED_BY(mutex_);
  const Log log_;
  std::string last_loss_ RR_GUARDED_BY(mutex_);
};

/// One object of a board.
class BoardObject final : public Skeleton, public std::enable_shared_from_this<BoardObject> {
 public:
  BoardObject(std::shared_ptr<BoardService> service, const dynamic::ObjectTable& table,
              std::uint8_t number);

  [[nodiscard]] const ObjectType& rr_object_type() const override { return *table_.wire_type; }
  void rr_attached(ServiceContext& context, const std::string& path) override;
  void rr_dispatch(std::size_t member, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) override;

  void handle(const Unasked& one);

 private:
  using Body = std::vector<std::uint8_t>;
  [[nodiscard]] Body body_of(std::size_t member) const;
  [[nodiscard]] const Member& wire_of(std::size_t member) const {
    return table_.wire_members[member];
  }
  void serve_wire(std::size_t member);
  void serve_pipe(std::size_t member);
  dynamic::Value peek(std::size_t member);
  /// Callbacks are called with a pack of arguments, which is made here one by one.
  static constexpr std::size_t most_callback_parameters = 16;
  template <class... Arguments>
  dynamic::Value call_back_with(std::size_t member, const dynamic::List& rest, std::uint32_t client,
                                const Arguments&... before);
  dynamic::Value call_back(std::size_t member, const dynamic::List& arguments,
                           std::uint32_t client);
  void answer_callback(std::size_t member, const dynamic::List& arguments, std::uint32_t client);
  [[nodiscard]] dynamic::List parameters_in(std::size_t member,
                                            std::span<const std::uint8_t>& bytes) const;

  const std::shared_ptr<BoardService> service_;
  const dynamic::ObjectTable& table_;
  const std::uint8_t number_;
  bool is_served_ = false;
};

}  // namespace rr::serial
