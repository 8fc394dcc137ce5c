// SPDX-License-Identifier: Apache-2.0
#include "cli/live/prompt.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <ostream>
#include <rr/error.hpp>
#include <rr/locks.hpp>
#include <rr/printable.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/commands.hpp"
#include "cli/live/commands.hpp"
#include "cli/live/complete.hpp"
#include "cli/live/connection.hpp"
#include "cli/live/describe.hpp"
#include "cli/live/line_reader.hpp"
#include "cli/live/line_words.hpp"
#include "cli/live/members.hpp"
#include "cli/live/object_path.hpp"
#include "cli/live/watch.hpp"
#include "cli/options.hpp"
#include "compiler/diagnostics/spelling.hpp"
#include "rr/mutex.hpp"

namespace robdef::live {
namespace {

using rr::dynamic::Object;
using Words = std::span<const std::string>;

class Prompt {
 public:
  Prompt(const std::string& url, const LiveOptions& options, std::ostream& out, std::ostream& err)
      : out_(out),
        err_(err),
        connection_(options, url, [this](const rr::Error& why) { tell_closed(why); }) {}

  ExitStatus run() {
    const auto reader = make_line_reader([this](const std::string& before) {
      try {
        return complete(before);
      } catch (const rr::Error&) {
        return std::vector<std::string>();  // what is wrong is told when the line is entered
      }
    });
    while (!is_over_) {
      const auto line = read(*reader);
      if (!line) {
        if (reader->is_terminal()) out_ << std::endl;
        break;
      }
      const bool is_done = enter(*line);
      has_failed_ = has_failed_ || !is_done;
    }
    return has_failed_ && !reader->is_terminal() ? exit_errors : exit_fine;
  }

 private:
  struct Row {
    std::string_view name;
    std::string_view arguments;
    std::string_view help;
    void (Prompt::*act)(Words words);
  };
  static const std::array<Row, 11> rows;

  std::optional<std::string> read(LineReader& reader) {
    const EndSignals::Allowed ends_program(signals_);
    const std::string path = text_of(path_);
    return reader.read(connection_.root().path() + (path.empty() ? "" : "." + path) + "> ");
  }

  // False when it has failed, which is told.
  bool enter(const std::string& line) {
    const std::vector<std::string> words = split_line(line).words;
    if (words.empty() || words.front().starts_with('#')) return true;
    try {
      const auto row = std::find_if(rows.begin(), rows.end(),
                                    [&](const Row& each) { return each.name == words.front(); });
      if (row == rows.end()) refuse(unknown(words.front()));
      keep_connected();
      (this->*row->act)(words);
      out_.flush();
      return true;
    } catch (const rr::Error& error) {
      out_.flush();
      err_ << "robdef: " << rr::printable(error.what(), longest_message) << std::endl;
      return false;
    }
  }

  static std::string unknown(const std::string& name) {
    std::vector<std::string_view> names;
    for (const Row& row : rows) names.push_back(row.name);
    const std::string_view near = nearest(name, names);
    return "unknown command `" + name + "`; " +
           (near.empty() ? "`help` lists them" : "did you mean `" + std::string(near) + "`?");
  }

  void keep_connected() {
    if (connection_.is_open()) return;
    here_.reset();
    err_ << "robdef: the connection was lost; connecting again, without its locks" << std::endl;
    connection_.connect();
  }

  const Object& here() {
    if (!here_) here_ = object_at(connection_.root(), path_);
    return *here_;
  }

  // The line as the command line takes it: the service stands where its URL would.
  static Options understand(Words words) {
    std::vector<std::string> arguments(words.begin(), words.end());
    arguments.insert(arguments.begin() + 1, "rr+tcp://");
    auto parsed = parse_options(arguments, "", all_commands());
    if (const auto* error = std::get_if<UsageError>(&parsed)) refuse(error->text);
    if (auto* answer = std::get_if<Answer>(&parsed)) refuse(answer->text);
    Options options = std::get<Options>(std::move(parsed));
    options.inputs.erase(options.inputs.begin());
    return options;
  }

  ObjectPath below(std::string_view text) const {
    ObjectPath path = path_;
    for (PathStep& step : parse_object_path(text)) path.push_back(std::move(step));
    return path;
  }

  std::vector<std::string> complete(const std::string& before) {
    LineWords line = split_line(before);
    if (!line.is_last_open) line.words.emplace_back();
    if (line.words.size() == 1) {
      std::vector<std::string> found;
      for (const Row& row : rows) {
        if (row.name.starts_with(line.words[0])) found.emplace_back(row.name);
      }
      return found;
    }
    return completions(connection_.root(), path_, line.words.front(), line.words.back());
  }

  void get(Words words) {
    const Options options = understand(words);
    for (const std::string& member : options.inputs)
      live::get(here(), member, more(options).live, out_);
  }
  void set(Words words) {
    const Options options = understand(words);
    live::set(here(), options.inputs[0], options.inputs[1], more(options).live);
  }
  void call(Words words) {
    const Options options = understand(words);
    const auto no_lines = []() -> std::optional<std::string> {
      refuse("write the values of the steps behind the arguments");
    };
    live::call(here(), options.inputs.front(), Words(options.inputs).subspan(1), more(options).live,
               no_lines, out_);
  }
  void watch(Words words) {
    const Options options = understand(words);
    Watch watch(options.inputs, more(options).live);
    while (signals_.has_come()) continue;  // what came before is not meant
    const Watching watching(*this, watch);
    watch.attach(here());
    watch.run(signals_, out_);
  }
  void list(Words words) {
    if (words.size() > 2) refuse("`ls` takes one path");
    list_members(connection_.root(), words.size() < 2 ? path_ : below(words[1]), out_);
  }
  void go(Words words) {
    if (words.size() > 2) refuse("`cd` takes one path");
    ObjectPath path;
    if (words.size() == 2 && words[1] == "..") {
      path = path_;
      if (!path.empty()) path.pop_back();
    } else if (words.size() == 2 && words[1] != "/") {
      path = below(words[1].ends_with('.') ? words[1].substr(0, words[1].size() - 1) : words[1]);
    }
    here_ = object_at(connection_.root(), path);
    path_ = std::move(path);
  }
  void describe(Words words) {
    const Options options = understand(words);
    // At the root there is more to say: the definitions.
    const bool is_whole = options.inputs.empty();
    std::string path = text_of(path_);
    if (!is_whole) path += (path.empty() ? "" : ".") + options.inputs.front();
    if (options.format == Format::json) {
      describe_json(connection_.root(), path, out_);
    } else {
      describe_text(connection_.root(), path, out_);
    }
  }
  void lock(Words words) {
    rr::LockOwner owner = rr::LockOwner::user;
    if (words.size() > 1 && words.back() == "client") {
      owner = rr::LockOwner::session;
    } else if (words.size() > 1 && words.back() != "user") {
      refuse("a lock is for the `user` or for this `client`");
    }
    rr::lock(here().stub(), owner);
  }
  void unlock(Words) { rr::unlock(here().stub()); }
  void help(Words) {
    constexpr std::size_t column = 30;
    for (const Row& row : rows) {
      std::string left = std::string(row.name) + " " + std::string(row.arguments);
      left.resize(std::max(left.size() + 1, column), ' ');
      out_ << left << row.help << '\n';
    }
  }
  void quit(Words) { is_over_ = true; }

  // Tells a watch that nothing more comes.
  class Watching {
   public:
    Watching(Prompt& prompt, Watch& watch) : prompt_(prompt), watch_(watch) {
      const rr::MutexLock lock(prompt_.mutex_);
      prompt_.watch_ = &watch;
    }
    ~Watching() {
      {
        const rr::MutexLock lock(prompt_.mutex_);
        prompt_.watch_ = nullptr;
      }
      watch_.close();
    }
    Watching(const Watching&) = delete;
    Watching& operator=(const Watching&) = delete;

   private:
    Prompt& prompt_;
    Watch& watch_;
  };

  void tell_closed(const rr::Error& why) {
    const rr::MutexLock lock(mutex_);
    if (watch_ != nullptr) watch_->post([why] { throw rr::Error(why); });
  }

  std::ostream& out_;
  std::ostream& err_;
  const EndSignals signals_;
  rr::Mutex mutex_;
  Watch* watch_ RR_GUARDED_BY(mutex_) = nullptr;
  ObjectPath path_;
  bool is_over_ = false;
  bool has_failed_ = false;
  Connection connection_;
  std::optional<Object> here_;
};

const std::array<Prompt::Row, 11> Prompt::rows = {{
    {"get", "MEMBER...", "value of a property, wire or memory", &Prompt::get},
    {"set", "MEMBER JSON", "set it", &Prompt::set},
    {"call", "MEMBER [JSON...]", "call a function", &Prompt::call},
    {"watch", "MEMBER...", "wires, pipes, events; until Ctrl-C", &Prompt::watch},
    {"ls", "[PATH]", "members of this object, or another", &Prompt::list},
    {"cd", "[PATH | .. | /]", "go to another object", &Prompt::go},
    {"describe", "[PATH]", "members with their documentation", &Prompt::describe},
    {"lock", "[user | client]", "keep others from this object", &Prompt::lock},
    {"unlock", "", "end that", &Prompt::unlock},
    {"help", "", "this list", &Prompt::help},
    {"quit", "", "end; so does the end of the input", &Prompt::quit},
}};

}  // namespace

ExitStatus prompt(const std::string& url, const LiveOptions& options, std::ostream& out,
                  std::ostream& err) {
  return Prompt(url, options, out, err).run();
}

}  // namespace robdef::live
