// SPDX-License-Identifier: Apache-2.0
#include "gateway/export_file.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "compiler/project/toml_file.hpp"
#include "gateway/topics.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using robdef::Span;
using Toml = robdef::project::Value;
using Kind = Toml::Kind;

struct Unit {
  std::string_view name;
  double factor;
};
constexpr Unit sizes[] = {{"B", 1},
                          {"kB", 1e3},
                          {"MB", 1e6},
                          {"GB", 1e9},
                          {"KiB", 1024},
                          {"MiB", 1024.0 * 1024},
                          {"GiB", 1024.0 * 1024 * 1024}};
constexpr Unit times[] = {{"ms", 1e-3}, {"s", 1},      {"min", 60},
                          {"h", 3600},  {"d", 86'400}, {"days", 86'400}};
constexpr Unit rates[] = {{"/s", 1}, {"/min", 1.0 / 60}, {"Hz", 1}};

class FileReader {
 public:
  FileReader(const std::string& name, std::string text, Secrets secrets)
      : folder_(std::filesystem::path(name).parent_path()), secrets_(secrets) {
    const robdef::SourceId id = sources_.add(name, std::move(text));
    robdef::Report report;
    root_ = robdef::project::parse_toml(sources_[id], id, report);
    for (const robdef::Diagnostic* found : report.sorted()) {
      mistake(found->primary().span, "no valid TOML: " + found->primary().text);
    }
  }

  ExportFile read() {
    if (mistakes_.empty()) read_root();
    if (mistakes_.empty()) return std::move(file_);
    throw Error(ErrorCode::invalid_configuration, mistakes_);
  }

 private:
  void mistake(Span span, const std::string& what) {
    const robdef::Source& source = sources_[span.source];
    const robdef::Position place = source.position(span.begin);
    if (!mistakes_.empty()) mistakes_ += "\n";
    mistakes_ += source.name() + ":" + std::to_string(place.line) + ":" +
                 std::to_string(place.column) + ": " + what;
  }

  void unknown(const Toml::Entry& entry, std::string_view where) {
    mistake(entry.span, "`" + entry.key + "` is no key of " + std::string(where));
  }

  std::string text(const Toml& value) {
    if (value.kind == Kind::text) return value.text;
    mistake(value.span, "a text is expected");
    return {};
  }

  std::string level(const Toml& value) {
    std::string name = text(value);
    if (value.kind == Kind::text && !is_level_name(name)) {
      mistake(value.span, "a name has 1 to 64 letters, digits, `_` or `-`");
    }
    return name;
  }

  template <class Read>
  auto list(const Toml& value, Read read) {
    std::vector<decltype(read(value))> items;
    if (value.kind == Kind::list) {
      for (const Toml& item : value.items) items.push_back(read(item));
    } else {
      mistake(value.span, "a list is expected");
    }
    return items;
  }

  std::vector<std::string> levels(const Toml& value) {
    return list(value, [this](const Toml& item) { return level(item); });
  }

  /// `10 MiB` in bytes, `5 s` in seconds.
  template <std::size_t n>
  double amount(const Toml& value, const Unit (&units)[n], const char* example) {
    const std::string given = text(value);
    double number = 0;
    const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), number);
    std::string_view rest(end, given.data() + given.size());
    if (rest.starts_with(' ')) rest.remove_prefix(1);
    const Unit* const unit = std::ranges::find(units, rest, &Unit::name);
    if (error == std::errc() && number > 0 && number < 1e15 && unit != std::end(units)) {
      return number * unit->factor;
    }
    if (value.kind == Kind::text) mistake(value.span, std::string("not such as `") + example + "`");
    return 1;
  }

  std::string file_name(const Toml& value) { return (folder_ / text(value)).string(); }

  std::string secret(const Toml& value) {
    const std::string name = file_name(value);
    if (secrets_ == Secrets::ignored) return {};
    try {
      return read_secret(name);
    } catch (const Error& error) {
      mistake(value.span, error.message());
      return {};
    }
  }

  /// Of a stream in a cluster: more than half of them have to be there.
  int replicas(const Toml& value) {
    const std::string given = text(value);
    for (const int count : {1, 3, 5}) {
      if (given == std::to_string(count)) return count;
    }
    if (value.kind == Kind::text) mistake(value.span, "`replicas` is \"1\", \"3\" or \"5\"");
    return 1;
  }

  void read_broker(const Toml& table) {
    for (const Toml::Entry& entry : entries(table)) {
      if (entry.key == "url") {
        file_.broker.url = text(entry.value);
      } else if (entry.key == "user") {
        file_.broker.user = text(entry.value);
      } else if (entry.key == "password_file") {
        file_.broker.password = secret(entry.value);
      } else if (entry.key == "authority") {
        file_.broker.authority = file_name(entry.value);
      } else if (entry.key == "certificate") {
        file_.broker.certificate = file_name(entry.value);
      } else if (entry.key == "key") {
        file_.broker.key = file_name(entry.value);
      } else if (entry.key == "token_file") {
        file_.broker.token = secret(entry.value);
      } else if (entry.key == "credentials") {
        file_.broker.credentials = file_name(entry.value);
      } else if (entry.key == "replicas") {
        file_.broker.replicas = replicas(entry.value);
      } else {
        unknown(entry, "[broker]");
      }
    }
  }

  const std::vector<Toml::Entry>& entries(const Toml& value) {
    if (value.kind != Kind::table) mistake(value.span, "a table is expected");
    return value.entries;
  }

  std::uint8_t access(const Toml& value) {
    std::uint8_t all = 0;
    for (const auto& word :
         list(value, [this](const Toml& item) { return std::pair(text(item), item.span); })) {
      const std::uint8_t one = word.first == "read"    ? reading
                               : word.first == "write" ? writing
                               : word.first == "call"  ? calling
                               : word.first == "lock"  ? locking
                                                       : 0;
      if (one == 0) mistake(word.second, "access is `read`, `write`, `call` or `lock`");
      all |= one;
    }
    return all;
  }

  std::string path(const Toml& value) {
    std::string pattern = text(value);
    if (pattern.find('*') != std::string::npos) {
      if (pattern.find_first_of("/+#$ ") != std::string::npos) {
        mistake(value.span, "`" + pattern + "` is no path of objects");
      }
      return pattern;
    }
    try {
      // As topics have it: percent signs with capital letters.
      std::string path;
      for (const PathStep& step : path_steps(pattern)) path = path_below(path, step);
      return path;
    } catch (const Error& error) {
      mistake(value.span, error.message());
    }
    return pattern;
  }

  std::string member(const Toml& value) {
    std::string pattern = text(value);
    std::string name = pattern;
    std::erase(name, '*');
    if (value.kind == Kind::text && pattern.find('-') == std::string::npos &&
        (name.empty() ? !pattern.empty() : is_level_name(name))) {
      return pattern;
    }
    if (value.kind == Kind::text) mistake(value.span, "`" + pattern + "` is no name of a member");
    return pattern;
  }

  bool read_rule_key(const Toml::Entry& entry, ExportRule& rule) {
    if (entry.key == "path") {
      rule.path = path(entry.value);
    } else if (entry.key == "members") {
      rule.members = list(entry.value, [this](const Toml& item) { return member(item); });
    } else if (entry.key == "access") {
      rule.access = access(entry.value);
    } else if (entry.key == "users") {
      rule.users = levels(entry.value);
    } else if (entry.key == "rate") {
      const double rate = amount(entry.value, rates, "20/s");
      rule.period = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate));
    } else if (entry.key == "lifespan") {
      const double seconds = amount(entry.value, times, "5 s");
      rule.lifespan =
          std::chrono::seconds(std::max<std::int64_t>(1, static_cast<std::int64_t>(seconds)));
    } else {
      return false;
    }
    return true;
  }

  ExportRule read_rule(const Toml& table) {
    ExportRule rule;
    for (const Toml::Entry& entry : entries(table)) {
      if (!read_rule_key(entry, rule)) unknown(entry, "[[service.allow]]");
    }
    if (rule.members.empty()) mistake(table.span, "[[service.allow]] needs `members`");
    if (rule.access == 0) mistake(table.span, "[[service.allow]] needs `access`");
    return rule;
  }

  std::pair<BrokerUser, MappedUser> read_user(const Toml& table) {
    std::pair<BrokerUser, MappedUser> user;
    for (const Toml::Entry& entry : entries(table)) {
      if (entry.key == "broker") {
        user.first.name = level(entry.value);
      } else if (entry.key == "client") {
        user.first.client = text(entry.value);
      } else if (entry.key == "service") {
        user.second.name = text(entry.value);
      } else if (entry.key == "password_file") {
        user.second.password = secret(entry.value);
      } else {
        unknown(entry, "[[service.user]]");
      }
    }
    if (user.first.name.empty()) mistake(table.span, "[[service.user]] needs `broker`");
    if (user.second.name.empty()) mistake(table.span, "[[service.user]] needs `service`");
    return user;
  }

  void read_users(const Toml& value, ExportedServiceOptions& service) {
    for (auto& [user, login] : list(value, [this](const Toml& item) { return read_user(item); })) {
      if (service.users.emplace(user, login).second) continue;
      const std::string client = user.client.empty() ? "" : ", client `" + user.client + "`,";
      mistake(value.span, "user `" + user.name + "`" + client + " is there twice");
    }
  }

  bool read_service_key(const Toml::Entry& entry, ExportedServiceOptions& service) {
    if (entry.key == "name") {
      service.name = level(entry.value);
    } else if (entry.key == "url") {
      service.url = text(entry.value);
    } else if (entry.key == "login") {
      service.login.name = text(entry.value);
    } else if (entry.key == "password_file") {
      service.login.password = secret(entry.value);
    } else if (entry.key == "readers") {
      service.readers = levels(entry.value);
    } else if (entry.key == "log_size") {
      service.log_bytes = static_cast<std::uint64_t>(amount(entry.value, sizes, "256 MiB"));
    } else if (entry.key == "log_age") {
      service.log_age =
          std::chrono::seconds(static_cast<std::int64_t>(amount(entry.value, times, "7 days")));
    } else if (entry.key == "session_limit") {
      service.session_limit =
          std::chrono::seconds(static_cast<std::int64_t>(amount(entry.value, times, "30 s")));
    } else if (entry.key == "allow") {
      service.rules = list(entry.value, [this](const Toml& item) { return read_rule(item); });
    } else if (entry.key == "user") {
      read_users(entry.value, service);
    } else {
      return false;
    }
    return true;
  }

  ExportedServiceOptions read_service(const Toml& table) {
    ExportedServiceOptions service;
    for (const Toml::Entry& entry : entries(table)) {
      if (!read_service_key(entry, service)) unknown(entry, "[[service]]");
    }
    if (service.name.empty()) mistake(table.span, "[[service]] needs `name`");
    if (service.url.empty()) mistake(table.span, "[[service]] needs `url`");
    if (!names_.insert(service.name).second) {
      mistake(table.span, "service `" + service.name + "` is there twice");
    }
    return service;
  }

  void read_root_key(const Toml::Entry& entry) {
    if (entry.key == "site") {
      file_.site = level(entry.value);
    } else if (entry.key == "node") {
      file_.node = level(entry.value);
    } else if (entry.key == "state") {
      file_.state_folder = file_name(entry.value);
    } else if (entry.key == "broker") {
      read_broker(entry.value);
    } else if (entry.key == "service") {
      file_.services = list(entry.value, [this](const Toml& item) { return read_service(item); });
    } else {
      unknown(entry, "an export file");
    }
  }

  void read_root() {
    for (const Toml::Entry& entry : root_.entries) read_root_key(entry);
    const auto need = [this](const std::string& value, const char* key) {
      if (value.empty())
        mistake({root_.span.source, 0, 0}, std::string("`") + key + "` is missing");
    };
    need(file_.site, "site");
    need(file_.node, "node");
    need(file_.state_folder, "state");
    need(file_.broker.url, "broker.url");
    if (file_.services.empty()) mistake({root_.span.source, 0, 0}, "`[[service]]` is missing");
  }

  std::filesystem::path folder_;
  Secrets secrets_;
  robdef::Sources sources_;
  Toml root_;
  ExportFile file_;
  std::set<std::string> names_;
  std::string mistakes_;
};

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file.good() && !file.eof()) {
    throw Error(ErrorCode::resource_not_found, path + " cannot be read");
  }
  return text;
}

}  // namespace

std::string read_secret(const std::string& path) {
  std::string text = read_file(path);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

ExportFile parse_export_file(const std::string& name, std::string text, Secrets secrets) {
  return FileReader(name, std::move(text), secrets).read();
}

ExportFile read_export_file(const std::string& path, Secrets secrets) {
  return parse_export_file(path, read_file(path), secrets);
}

}  // namespace rr::gateway
