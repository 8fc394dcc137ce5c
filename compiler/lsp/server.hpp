// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <set>
#include <string>

#include "compiler/lsp/protocol.hpp"
#include "compiler/lsp/workspace.hpp"

namespace robdef::lsp {

/// Answers messages, one after the other. Knows nothing of streams and threads.
class Server {
 public:
  using Send = std::function<void(const Json& message)>;

  /// `send` gets answers, notifications and requests to the client.
  Server(WorkspaceOptions options, Send send)
      : workspace_(std::move(options)), send_(std::move(send)) {}

  /// Takes any JSON; what is no message is answered with an error.
  void take(const Json& message);
  /// Answers a request that the client no longer wants.
  void refuse_cancelled(const Json& request);
  /// A message that is no JSON, or not framed as one.
  void report_unreadable(ErrorCode code, std::string_view why);
  /// Publishes the diagnostics that have become old. To be called when no message waits.
  void publish();
  [[nodiscard]] bool has_to_publish() const { return !stale_.empty(); }

  [[nodiscard]] bool is_ended() const { return state_ == State::ended; }
  /// 0 when the client has asked for the shutdown, else 1.
  [[nodiscard]] int exit_code() const { return is_shut_down_ ? 0 : 1; }

 private:
  enum class State { waiting, running, shut_down, ended };

  void request(const Json& id, const std::string& method, const Json& params);
  void notify(const std::string& method, const Json& params);
  Json result_of(const std::string& method, const Json& params);
  Json initialize(const Json& params);
  [[nodiscard]] Json capabilities() const;
  void watch_files();

  void publish(const Document& document);
  void log(const std::string& message);

  void did_open(const Json& params);
  void did_change(const Json& params);
  void did_close(const Json& params);
  void did_change_watched(const Json& params);
  void did_change_folders(const Json& params);
  void changed(const std::string& path);
  void change_all();

  /// Of the document that a request is about.
  std::shared_ptr<const Analysis> analysis_of(const Json& params);
  [[nodiscard]] std::uint32_t offset_of(const Analysis& analysis, const Json& params) const;

  Workspace workspace_;
  const Send send_;
  State state_ = State::waiting;
  bool is_shut_down_ = false;
  bool can_watch_ = false;
  Encoding encoding_ = Encoding::utf16;
  std::set<std::string> stale_;  // paths of open documents
};

}  // namespace robdef::lsp
