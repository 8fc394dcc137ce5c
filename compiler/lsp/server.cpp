// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/server.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "compiler/lsp/completion.hpp"
#include "compiler/lsp/diagnostics.hpp"
#include "compiler/lsp/navigation.hpp"
#include "compiler/lsp/symbols.hpp"
#include "compiler/lsp/uri.hpp"

namespace robdef::lsp {
namespace {

bool is_id(const Json& id) { return id.is_string() || id.is_number_integer(); }

Json id_of(const Json& message) {
  const Json& id = at_path(message, {"id"});
  return is_id(id) ? id : Json();
}

std::string uri_of_document(const Json& params) {
  return text_of(part_of(params, "textDocument"), "uri");
}

bool offers_utf8(const Json& params) {
  const Json& offered = at_path(params, {"capabilities", "general", "positionEncodings"});
  return offered.is_array() && std::ranges::find(offered, Json("utf-8")) != offered.end();
}

}  // namespace

void Server::report_unreadable(ErrorCode code, std::string_view why) {
  send_(error_response(nullptr, code, why));
}

void Server::refuse_cancelled(const Json& request) {
  send_(error_response(id_of(request), ErrorCode::request_cancelled, "cancelled by the client"));
}

void Server::take(const Json& message) {
  const Json& method = at_path(message, {"method"});
  const Json& id = at_path(message, {"id"});
  const bool has_id = message.is_object() && message.contains("id");
  if (!method.is_string()) {
    // An answer to a request of the server; nothing depends on it.
    const bool is_answer =
        message.is_object() && (message.contains("result") || message.contains("error"));
    if (!is_answer) {
      send_(error_response(id_of(message), ErrorCode::invalid_request, "a message has a method"));
    }
    return;
  }
  if (at_path(message, {"jsonrpc"}) != Json("2.0") || (has_id && !is_id(id))) {
    send_(error_response(id_of(message), ErrorCode::invalid_request,
                         "a message has `jsonrpc` 2.0, and a number or string as its id"));
    return;
  }
  const Json& params = at_path(message, {"params"});
  if (has_id) {
    request(id, method.get<std::string>(), params);
  } else {
    notify(method.get<std::string>(), params);
  }
}

void Server::request(const Json& id, const std::string& method, const Json& params) {
  try {
    if (state_ == State::waiting && method != "initialize") {
      throw RequestError(ErrorCode::server_not_initialized, "`initialize` comes first");
    }
    if (state_ == State::shut_down) {
      throw RequestError(ErrorCode::invalid_request, "the server is shut down");
    }
    send_(response(id, result_of(method, params)));
  } catch (const RequestError& error) {
    send_(error_response(id, error.code(), error.what()));
  } catch (const std::exception& error) {
    send_(error_response(id, ErrorCode::internal_error, error.what()));
  }
}

void Server::notify(const std::string& method, const Json& params) {
  if (method == "exit") {
    state_ = State::ended;
    return;
  }
  if (state_ != State::running) return;
  // There is no answer that could say what is wrong with a notification.
  try {
    if (method == "textDocument/didOpen") did_open(params);
    if (method == "textDocument/didChange") did_change(params);
    if (method == "textDocument/didClose") did_close(params);
    if (method == "textDocument/didSave") changed(identity_of_uri(uri_of_document(params)));
    if (method == "workspace/didChangeWatchedFiles") did_change_watched(params);
    if (method == "workspace/didChangeWorkspaceFolders") did_change_folders(params);
    if (method == "initialized") watch_files();
  } catch (const std::exception& error) {
    log(method + ": " + error.what());
  }
}

void Server::log(const std::string& message) {
  constexpr int error_message = 1;
  send_(notification("window/logMessage", {{"type", error_message}, {"message", message}}));
}

Json Server::result_of(const std::string& method, const Json& params) {
  if (method == "initialize") return initialize(params);
  if (method == "shutdown") {
    state_ = State::shut_down;
    is_shut_down_ = true;
    return nullptr;
  }
  if (method == "workspace/symbol") {
    return workspace_symbols(workspace_, text_of(params, "query"), encoding_);
  }
  using Of = Json (*)(const Analysis&, Encoding);
  constexpr std::pair<std::string_view, Of> of_documents[] = {
      {"textDocument/documentSymbol", document_symbols},
      {"textDocument/foldingRange", folding_ranges},
      {"textDocument/semanticTokens/full", semantic_tokens},
      {"textDocument/formatting", formatting_edits},
  };
  for (const auto& [name, function] : of_documents) {
    if (name == method) return function(*analysis_of(params), encoding_);
  }
  const std::string_view known[] = {"textDocument/completion",
                                    "textDocument/hover",
                                    "textDocument/definition",
                                    "textDocument/references",
                                    "textDocument/documentHighlight",
                                    "textDocument/prepareRename",
                                    "textDocument/rename",
                                    "textDocument/codeAction"};
  if (std::ranges::find(known, method) == std::end(known)) {
    throw RequestError(ErrorCode::method_not_found, "`" + method + "` is not offered");
  }
  const auto analysis = analysis_of(params);
  if (method == "textDocument/codeAction") {
    return code_actions(*analysis, workspace_, range_from(part_of(params, "range")), encoding_);
  }
  const std::uint32_t offset = offset_of(*analysis, params);
  if (method == "textDocument/completion") {
    return completions_at(*analysis, workspace_, offset, encoding_);
  }
  if (method == "textDocument/hover") return hover_at(*analysis, offset, encoding_);
  if (method == "textDocument/definition") {
    return definition_of(*analysis, workspace_, offset, encoding_);
  }
  if (method == "textDocument/references") {
    const bool with_declarations = is_true(part_of(params, "context"), "includeDeclaration");
    return references_to(*analysis, workspace_, offset, with_declarations, encoding_);
  }
  if (method == "textDocument/documentHighlight") {
    return highlights_of(*analysis, offset, encoding_);
  }
  if (method == "textDocument/prepareRename") return prepare_rename(*analysis, offset, encoding_);
  return rename_at(*analysis, workspace_, offset, text_of(params, "newName"), encoding_);
}

Json Server::initialize(const Json& params) {
  if (state_ != State::waiting) {
    throw RequestError(ErrorCode::invalid_request, "`initialize` comes once");
  }
  encoding_ = offers_utf8(params) ? Encoding::utf8 : Encoding::utf16;
  can_watch_ = is_true(at_path(params, {"capabilities", "workspace", "didChangeWatchedFiles"}),
                       "dynamicRegistration");
  const Json& folders = at_path(params, {"workspaceFolders"});
  const Json& root = at_path(params, {"rootUri"});
  if (folders.is_array()) {
    for (const Json& folder : folders) workspace_.add_folder(path_of(text_of(folder, "uri")));
  } else if (root.is_string()) {
    workspace_.add_folder(path_of(root.get<std::string>()));
  }
  state_ = State::running;
  return {{"capabilities", capabilities()},
          {"serverInfo", {{"name", "robdef"}, {"version", workspace_.version()}}}};
}

Json Server::capabilities() const {
  constexpr int incremental = 2;
  return {
      {"positionEncoding", encoding_ == Encoding::utf8 ? "utf-8" : "utf-16"},
      {"textDocumentSync", {{"openClose", true}, {"change", incremental}, {"save", true}}},
      {"completionProvider", {{"triggerCharacters", {".", "[", "{", "(", " "}}}},
      {"hoverProvider", true},
      {"definitionProvider", true},
      {"referencesProvider", true},
      {"documentHighlightProvider", true},
      {"documentSymbolProvider", true},
      {"workspaceSymbolProvider", true},
      {"foldingRangeProvider", true},
      {"documentFormattingProvider", true},
      {"renameProvider", {{"prepareProvider", true}}},
      {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
      {"semanticTokensProvider", {{"legend", semantic_legend()}, {"full", true}}},
      {"workspace", {{"workspaceFolders", {{"supported", true}, {"changeNotifications", true}}}}},
  };
}

void Server::watch_files() {
  if (!can_watch_) return;
  Json watchers = Json::array();
  for (const char* pattern : {"**/*.robdef", "**/robdef.toml"}) {
    watchers.push_back({{"globPattern", pattern}});
  }
  Json registration = {{"id", "files"},
                       {"method", "workspace/didChangeWatchedFiles"},
                       {"registerOptions", {{"watchers", std::move(watchers)}}}};
  send_({{"jsonrpc", "2.0"},
         {"id", "watch"},
         {"method", "client/registerCapability"},
         {"params", {{"registrations", Json::array({std::move(registration)})}}}});
}

void Server::did_open(const Json& params) {
  const Json& document = part_of(params, "textDocument");
  const Json& version = at_path(document, {"version"});
  const std::string path = workspace_
                               .open(text_of(document, "uri"),
                                     version.is_number_integer() ? version.get<std::int64_t>() : 0,
                                     text_of(document, "text"))
                               .path;
  changed(path);
}

void Server::did_change(const Json& params) {
  Document* const document = workspace_.find(uri_of_document(params));
  if (document == nullptr) {
    throw RequestError(ErrorCode::invalid_params, "the document is not open");
  }
  const Json& version = at_path(params, {"textDocument", "version"});
  if (version.is_number_integer()) document->version = version.get<std::int64_t>();
  // Others may depend on what it was until now.
  const std::string path = document->path;
  for (const auto& [other, open] : workspace_.documents()) {
    if (workspace_.depends(open, path)) stale_.insert(other);
  }
  // Whatever becomes of the changes: those before one that is refused stay.
  workspace_.forget(path);
  stale_.insert(path);
  for (const Json& change : part_of(params, "contentChanges")) {
    const std::string text = text_of(change, "text");
    if (change.contains("range")) {
      document->text.replace(range_from(change["range"]), text, encoding_);
    } else {
      document->text = Text(text);
    }
  }
}

void Server::did_close(const Json& params) {
  const std::string uri = uri_of_document(params);
  const Document* const document = workspace_.find(uri);
  if (document == nullptr) return;
  const std::string path = document->path;
  changed(path);
  workspace_.close(uri);
  stale_.erase(path);
  send_(notification("textDocument/publishDiagnostics",
                     {{"uri", uri}, {"diagnostics", Json::array()}}));
}

void Server::did_change_watched(const Json& params) {
  static_cast<void>(part_of(params, "changes"));
  change_all();
}

void Server::did_change_folders(const Json& params) {
  const Json& event = part_of(params, "event");
  for (const Json& folder : part_of(event, "removed")) {
    workspace_.remove_folder(path_of(text_of(folder, "uri")));
  }
  for (const Json& folder : part_of(event, "added")) {
    workspace_.add_folder(path_of(text_of(folder, "uri")));
  }
}

void Server::changed(const std::string& path) {
  for (const auto& [other, open] : workspace_.documents()) {
    if (other == path || workspace_.depends(open, path)) stale_.insert(other);
  }
  workspace_.forget(path);
}

void Server::change_all() {
  workspace_.forget_all();
  for (const auto& [path, open] : workspace_.documents()) stale_.insert(path);
}

void Server::publish() {
  for (const std::string& path : std::exchange(stale_, {})) {
    const auto open = workspace_.documents().find(path);
    if (open == workspace_.documents().end()) continue;
    // One document with which the compiler has a fault leaves the others alone.
    try {
      publish(open->second);
    } catch (const std::exception& error) {
      log("diagnostics of " + open->second.uri + ": " + error.what());
    }
  }
}

void Server::publish(const Document& document) {
  const auto analysis = workspace_.analysis(document.path);
  if (!analysis) return;
  send_(notification("textDocument/publishDiagnostics",
                     {{"uri", document.uri},
                      {"version", document.version},
                      {"diagnostics", diagnostics_of(*analysis, workspace_, encoding_)}}));
}

std::shared_ptr<const Analysis> Server::analysis_of(const Json& params) {
  const std::string uri = uri_of_document(params);
  const Document* const document = workspace_.find(uri);
  auto analysis = document == nullptr ? nullptr : workspace_.analysis(document->path);
  if (!analysis) throw RequestError(ErrorCode::invalid_params, "`" + uri + "` is not open");
  return analysis;
}

std::uint32_t Server::offset_of(const Analysis& analysis, const Json& params) const {
  return analysis.text().offset(place_from(part_of(params, "position")), encoding_);
}

}  // namespace robdef::lsp
