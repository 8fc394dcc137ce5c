// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/pending.hpp"

#include <cstring>
#include <utility>

namespace rr::endpoint {

namespace {

// A service that answers no opening is not asked for more than so many ends.
constexpr std::size_t most_abandoned = 1024;

// What is left of a text, in one word: less than eight letters. With their number no two texts give
// the same.
std::uint64_t rest(std::string_view text) {
  if (text.size() >= sizeof(std::uint32_t)) {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::memcpy(&first, text.data(), sizeof(first));
    std::memcpy(&last, text.data() + text.size() - sizeof(last), sizeof(last));
    return std::uint64_t{last} << 32 | first;
  }
  if (text.empty()) return 0;
  const auto letter = [text](std::size_t at) {
    return std::uint64_t{static_cast<unsigned char>(text[at])};
  };
  return letter(0) | letter(text.size() / 2) << 8 | letter(text.size() - 1) << 16;
}

// Quick, since there are four of them in each asynchronous call.
std::size_t hash(std::string_view text) {
  constexpr std::uint64_t odd = 0x9e37'79b9'7f4a'7c15;
  constexpr std::size_t step = sizeof(std::uint64_t);
  std::uint64_t result = text.size();
  const auto mix = [&result](std::uint64_t word) {
    result = (result ^ word) * odd;
    result ^= result >> 29;
  };
  for (; text.size() >= step; text.remove_prefix(step)) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data(), step);
    mix(word);
  }
  mix(rest(text));
  return result;
}

bool may_answer(EntryType answer, EntryType request) {
  const auto number = static_cast<std::uint16_t>(static_cast<std::uint16_t>(request) + 1);
  if (answer == static_cast<EntryType>(number)) return true;
  return request == EntryType::memory_write && answer == EntryType::memory_read_ret;  // 07, 13
}

// Implementations spell what is escaped in an index in different ways: it does not count.
std::string_view before_escapes(std::string_view path) { return path.substr(0, path.find('%')); }

std::size_t hash_of_path(std::string_view path) { return hash(before_escapes(path)); }

}  // namespace

Asked::Asked(EntryType type, std::string_view path, std::string_view member)
    : type_(type), path_{nullptr, hash_of_path(path)}, member_{nullptr, hash(member)} {}

[[gnu::hot]] Asked Asked::while_open(EntryType type, std::string_view path,
                                     std::string_view member) {
  Asked asked;
  asked.type_ = type;
  asked.path_ = {path.data(), path.size()};
  asked.member_ = {member.data(), member.size()};
  return asked;
}

Asked Asked::opening(EntryType type, std::string_view path, std::string_view member) {
  Asked asked(type, path, member);
  asked.opening_ = std::make_shared<const Opening>(Opening{std::string(path), std::string(member)});
  return asked;
}

[[gnu::hot]] bool Asked::is_path(std::string_view path) const {
  if (path_.letters == nullptr) return hash_of_path(path) == path_.size_or_hash;
  const std::string_view asked(path_.letters, path_.size_or_hash);
  return asked == path || before_escapes(asked) == before_escapes(path);
}

bool Asked::is_member(std::string_view member) const {
  if (member_.letters == nullptr) return hash(member) == member_.size_or_hash;
  return std::string_view(member_.letters, member_.size_or_hash) == member;
}

[[gnu::hot]] bool Asked::is_answered_by(const Entry& entry) const {
  return may_answer(entry.type, type_) &&
         (entry.service_path.empty() || is_path(entry.service_path)) &&
         (entry.member.empty() || is_member(entry.member));
}

// The link that points to the request, or the end of its chain.
Pending** PendingTable::find(std::uint32_t id) {
  Pending** link = &buckets_[id & (buckets_.size() - 1)];
  while (*link != nullptr && (*link)->id_ != id) link = &(*link)->next_;
  return link;
}

void PendingTable::grow() {
  std::vector<Pending*> old(buckets_.empty() ? 4 : 2 * buckets_.size());
  old.swap(buckets_);
  for (Pending* chain : old) {
    while (chain != nullptr) {
      Pending* const request = std::exchange(chain, chain->next_);
      request->next_ = std::exchange(buckets_[request->id_ & (buckets_.size() - 1)], request);
    }
  }
}

[[gnu::hot]] std::uint32_t PendingTable::add(Pending& request, Asked asked) {
  if (size_ == buckets_.size()) grow();
  request.asked_ = std::move(asked);
  request.id_ = skip();
  request.is_open_ = true;
  request.was_added_ = true;
  request.next_ = nullptr;
  *find(request.id_) = &request;
  ++size_;
  return request.id_;
}

std::uint32_t PendingTable::skip() {
  while (size_ != 0 && *find(next_id_) != nullptr) ++next_id_;
  return next_id_++;
}

Pending* PendingTable::take(Pending** link) {
  Pending* const request = *link;
  *link = request->next_;
  request->is_open_ = false;
  --size_;
  return request;
}

[[gnu::hot]] PendingTable::Answered PendingTable::take_answered(const Entry& entry) {
  Pending** const link = size_ != 0 ? find(entry.request_id) : nullptr;
  if (link == nullptr || *link == nullptr) return {nullptr, false, take_abandoned(entry)};
  if (!(*link)->asked_.is_answered_by(entry)) return {nullptr, true};
  return {take(link), false};
}

void PendingTable::abandon(const Pending& request) {
  if (!request.asked_.opened()) return;
  if (abandoned_.size() >= most_abandoned) abandoned_.erase(abandoned_.begin());
  abandoned_.insert_or_assign(request.id_, request.asked_);
}

std::shared_ptr<const Asked::Opening> PendingTable::take_abandoned(const Entry& entry) {
  const auto found = abandoned_.find(entry.request_id);
  if (found == abandoned_.end() || !found->second.is_answered_by(entry)) return nullptr;
  auto opening = found->second.opened();
  abandoned_.erase(found);
  return opening;
}

bool PendingTable::take(Pending& request) {
  if (!request.is_open_) return false;
  abandon(*take(find(request.id_)));
  return true;
}

Pending* PendingTable::take_any() {
  if (size_ == 0) return nullptr;
  for (Pending*& chain : buckets_) {
    if (chain == nullptr) continue;
    Pending* const request = take(&chain);
    abandon(*request);
    return request;
  }
  return nullptr;
}

}  // namespace rr::endpoint
