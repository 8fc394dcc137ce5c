// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <utility>

#include "rr/error.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/platform/random.hpp"
#include "runtime/cpp/src/service/password_hash.hpp"

namespace rr {

using service::are_same;
using service::crypt_password;

struct PasswordUsers::Account {
  User user;
  std::string hash;
  std::vector<NodeId> nodes;  // empty: any
  bool is_unsalted = false;
};

namespace {

constexpr std::size_t md5_digits = 32;
// As libcrypt.
constexpr std::size_t most_password_bytes = 511;

std::string_view next_word(std::string_view& line, std::string_view separators) {
  const std::size_t begin = std::min(line.find_first_not_of(separators), line.size());
  line.remove_prefix(begin);
  const std::size_t end = std::min(line.find_first_of(separators), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}
constexpr std::string_view blanks = " \t\r";

bool is_md5(std::string_view hash) {
  return hash.size() == md5_digits &&
         hash.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool can_be_hashed(std::string_view password) {
  return password.size() <= most_password_bytes && password.find('\0') == std::string_view::npos;
}

// What a password is compared with.
std::string hash_like(const std::string& password, const std::string& hash, bool is_unsalted) {
  return is_unsalted ? service::md5(password) : crypt_password(password, hash);
}

// Differs from process to process, so that nobody foresees what is made of it.
std::size_t secret() {
  static const std::size_t number = [] {
    std::size_t bits = 0;
    platform::fill_random(std::as_writable_bytes(std::span(&bits, 1)));
    return bits;
  }();
  return number;
}

Error refusal() { return {ErrorCode::authentication_error, "Invalid username or password"}; }

}  // namespace

PasswordUsers::~PasswordUsers() = default;

PasswordUsers::PasswordUsers(std::string_view text) {
  service::begin_hashing();
  std::size_t number = 0;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    line = line.substr(0, line.find('#'));
    const std::string_view name = next_word(line, blanks);
    if (name.empty()) continue;
    const auto fail = [&](const char* what) {
      throw Error(ErrorCode::invalid_configuration,
                  "users, line " + std::to_string(number) + ": " + what);
    };
    Account account;
    account.user.name = name;
    account.hash = next_word(line, blanks);
    account.is_unsalted = is_md5(account.hash);
    const bool is_hash =
        account.is_unsalted || (account.hash.starts_with('$') && service::knows_hash(account.hash));
    if (!is_hash) fail("the second word is no hash that is known");
    std::string_view privileges = next_word(line, blanks);
    if (privileges.empty()) fail("the third word says the privileges, `_` for none");
    for (auto word = next_word(privileges, ","); !word.empty() && word != "_";
         word = next_word(privileges, ",")) {
      account.user.privileges.emplace_back(word);
    }
    std::string_view nodes = next_word(line, blanks);
    for (auto word = next_word(nodes, ","); !word.empty(); word = next_word(nodes, ",")) {
      const auto node = NodeId::parse(word);
      if (!node) fail("the fourth word is a list of node ids");
      account.nodes.push_back(*node);
    }
    if (!next_word(line, blanks).empty()) fail("there are more than four words");
    for (const Account& other : accounts_) {
      if (other.user.name == name) fail("the user is there already");
    }
    accounts_.push_back(std::move(account));
  }
}

std::shared_ptr<PasswordUsers> PasswordUsers::from_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    throw Error(ErrorCode::invalid_configuration, "cannot read `" + path + "`");
  }
  return std::make_shared<PasswordUsers>(text);
}

std::string PasswordUsers::hash(std::string_view password) {
  if (!can_be_hashed(password)) {
    throw Error(ErrorCode::invalid_argument, "a password has less than 512 bytes and no NUL");
  }
  std::string hash = service::new_hash(password);
  if (hash.empty()) throw Error(ErrorCode::system_resource_error, "cannot hash a password");
  return hash;
}

User PasswordUsers::authenticate(const std::string& name,
                                 const std::map<std::string, VarValue>& credentials,
                                 const NodeId& node) const {
  const auto given = credentials.find("password");
  const auto* const password =
      given == credentials.end() ? nullptr : given->second.get_if<std::string>();
  if (password == nullptr) {
    throw Error(ErrorCode::authentication_error, "Password not supplied in credentials");
  }
  const auto account = std::find_if(accounts_.begin(), accounts_.end(),
                                    [&](const Account& item) { return item.user.name == name; });
  if (!can_be_hashed(*password)) throw refusal();
  if (account == accounts_.end()) {
    // As much work as for a user that exists, which is not to be found out by the time it takes:
    // always that of the same one for a name, as hashes may differ in what they cost.
    if (!accounts_.empty()) {
      const std::size_t place = std::hash<std::string>()(name) ^ secret();
      const Account& other = accounts_[place % accounts_.size()];
      hash_like(*password, other.hash, other.is_unsalted);
    }
    throw refusal();
  }
  const std::string hash = hash_like(*password, account->hash, account->is_unsalted);
  const bool may_come =
      account->nodes.empty() ||
      std::find(account->nodes.begin(), account->nodes.end(), node) != account->nodes.end();
  if (!are_same(hash, account->hash) || !may_come) throw refusal();
  return account->user;
}

std::vector<std::string> PasswordUsers::warnings() const {
  std::vector<std::string> result;
  for (const Account& account : accounts_) {
    if (!account.is_unsalted) continue;
    result.push_back("the password of user `" + account.user.name +
                     "` is kept as an MD5 without salt, which is easily broken: replace it by a "
                     "hash of rr::PasswordUsers::hash() or `mkpasswd -m yescrypt`");
  }
  return result;
}

}  // namespace rr
