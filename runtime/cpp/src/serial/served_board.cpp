// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/served_board.hpp"

#include <sstream>

#include "rr/error.hpp"

namespace rr::serial {
namespace {

constexpr std::chrono::milliseconds patience{5000};

/// The exceptions that a definition declares, qualified, in its order.
std::vector<std::string> exceptions_of(const std::string& text, const std::string& service) {
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    std::string name;
    if (words >> word >> name && word == "exception") names.push_back(service + "." + name);
  }
  return names;
}

}  // namespace

BoardService::BoardService(std::shared_ptr<Board> board, const BoardTexts& texts, Node& node,
                           Log log)
    : board_(std::move(board)), node_(node), log_(std::move(log)) {
  if (texts.texts.size() < 2) {
    throw Error(ErrorCode::service_definition_error, "the board has no definition");
  }
  std::istringstream names(texts.texts[0]);
  names >> name_ >> root_type_;
  tables_ = dynamic::Tables::read({texts.texts.begin() + 1, texts.texts.end()}, nullptr);
  if (tables_->find_object(root_type_) == nullptr) {
    throw Error(ErrorCode::service_definition_error, "the board's root is no object it defines");
  }
  for (const auto& [service, definition] : tables_->definitions()) {
    node_.add_definition(std::shared_ptr<const Definition>(tables_, &definition.wire));
  }
  exceptions_ = exceptions_of(texts.texts[1], root_type_.substr(0, root_type_.rfind('.')));
}

std::shared_ptr<BoardObject> BoardService::root() { return object(0, root_type_); }

std::shared_ptr<BoardObject> BoardService::object(std::uint8_t number, const std::string& type) {
  const dynamic::ObjectTable* const table = tables_->find_object(type);
  if (table == nullptr) throw Error(ErrorCode::object_not_found, "no object type " + type);
  const MutexLock lock(mutex_);
  std::shared_ptr<BoardObject>& object = objects_[number];
  if (!object) object = std::make_shared<BoardObject>(shared_from_this(), *table, number);
  return object;
}

void BoardService::handle(const Unasked& one) {
  if (one.body.size() < 2) return;
  std::shared_ptr<BoardObject> object;
  {
    const MutexLock lock(mutex_);
    const auto found = objects_.find(one.body[0]);
    // An object that no client has ever asked for has nobody to tell.
    if (found == objects_.end()) return;
    object = found->second;
  }
  object->handle(one);
}

void BoardService::ask(Kind kind, std::vector<std::uint8_t> body, Board::Done done,
                       std::uint32_t client) {
  std::shared_ptr<Board> board;
  {
    const MutexLock lock(mutex_);
    board = board_;
  }
  if (board == nullptr) {
    done({.kind = Outcome::Kind::reset});
  } else {
    board->ask(kind, std::move(body), patience, std::move(done), client);
  }
}

Outcome BoardService::ask(Kind kind, std::vector<std::uint8_t> body) {
  std::shared_ptr<Board> board;
  {
    const MutexLock lock(mutex_);
    board = board_;
  }
  if (board == nullptr) return {.kind = Outcome::Kind::reset};
  return board->ask(kind, std::move(body), patience);
}

void BoardService::set_wire(std::vector<std::uint8_t> body, Board::Done done) {
  const MutexLock lock(mutex_);
  if (board_ != nullptr) board_->set_wire(std::move(body), std::move(done));
}

void BoardService::open(std::uint8_t object, std::uint8_t member, bool opens) {
  {
    const MutexLock lock(mutex_);
    const bool is_change =
        opens ? open_.emplace(object, member).second : open_.erase({object, member}) != 0;
    if (!is_change) return;
  }
  ask(opens ? Kind::Open : Kind::Close, {object, member}, [](const Outcome&) {});
}

void BoardService::open_again() {
  std::set<std::pair<std::uint8_t, std::uint8_t>> wanted;
  {
    const MutexLock lock(mutex_);
    wanted = open_;
  }
  for (const auto& [object, member] : wanted) {
    ask(Kind::Open, {object, member}, [](const Outcome&) {});
  }
}

void BoardService::detach() {
  std::map<std::uint8_t, std::shared_ptr<BoardObject>> objects;
  const MutexLock lock(mutex_);
  board_.reset();
  // They and this own each other.
  objects.swap(objects_);
}

std::uint32_t BoardService::client_of(std::uint8_t sequence) {
  const MutexLock lock(mutex_);
  return board_ == nullptr ? 0 : board_->client_of(sequence);
}

void BoardService::report_lost(const std::string& what, std::string_view member,
                               const Outcome& outcome) {
  // A reset is told by the board itself. All other outcomes come on its thread, as does the log.
  if (outcome.kind == Outcome::Kind::reply || outcome.kind == Outcome::Kind::reset) return;
  const std::string text = what + " was lost: " + error_of(member, outcome).message();
  {
    const MutexLock lock(mutex_);
    if (std::exchange(last_loss_, text) == text) return;
  }
  if (log_) log_(text);
}

}  // namespace rr::serial
