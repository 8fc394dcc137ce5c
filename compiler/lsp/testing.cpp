// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/testing.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "compiler/lsp/uri.hpp"

namespace robdef::lsp::testing {

Editor::Editor(Json capabilities)
    : server({}, [this](const Json& message) { sent.push_back(message); }) {
  std::string pattern = (std::filesystem::temp_directory_path() / "robdef-lsp-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = pattern;
  call("initialize", {{"processId", nullptr},
                      {"rootUri", uri_of(pattern)},
                      {"capabilities", std::move(capabilities)}});
  notify("initialized", Json::object());
}

Editor::~Editor() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Editor::write(std::string_view name, std::string_view text) const {
  const std::filesystem::path path = folder_ / name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string Editor::uri(std::string_view name) const { return uri_of((folder_ / name).string()); }

void Editor::open(std::string_view name, std::string_view text) {
  notify("textDocument/didOpen", {{"textDocument",
                                   {{"uri", uri(name)},
                                    {"languageId", "robdef"},
                                    {"version", version_++},
                                    {"text", std::string(text)}}}});
}

void Editor::edit(std::string_view name, const Range& range, std::string_view text) {
  notify("textDocument/didChange",
         {{"textDocument", {{"uri", uri(name)}, {"version", version_++}}},
          {"contentChanges",
           Json::array({{{"range", to_json(range)}, {"text", std::string(text)}}})}});
}

void Editor::close(std::string_view name) {
  notify("textDocument/didClose", {{"textDocument", {{"uri", uri(name)}}}});
}

Json Editor::call(const char* method, Json params) {
  const int id = next_id_++;
  server.take({{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", std::move(params)}});
  return sent.back();
}

void Editor::notify(const char* method, Json params) {
  server.take({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
}

Json Editor::at(const char* method, std::string_view name, Place place, Json more) {
  more["textDocument"] = {{"uri", uri(name)}};
  more["position"] = to_json(place);
  const Json answer = call(method, std::move(more));
  EXPECT_TRUE(answer.contains("result")) << answer;
  return at_path(answer, {"result"});
}

Json Editor::of(const char* method, std::string_view name) {
  return at_path(call(method, {{"textDocument", {{"uri", uri(name)}}}}), {"result"});
}

Json Editor::diagnostics(std::string_view name) {
  server.publish();
  for (auto message = sent.rbegin(); message != sent.rend(); ++message) {
    if (at_path(*message, {"params", "uri"}) == Json(uri(name)) &&
        at_path(*message, {"method"}) == Json("textDocument/publishDiagnostics")) {
      return (*message)["params"]["diagnostics"];
    }
  }
  return nullptr;
}

std::vector<std::string> Editor::codes(std::string_view name) {
  std::vector<std::string> all;
  for (const Json& one : diagnostics(name)) all.push_back(one["code"]);
  return all;
}

std::string with_edits(std::string text, const Json& edits) {
  // From the end, so that the places of the others stay.
  std::vector<const Json*> sorted;
  for (const Json& edit : edits) sorted.push_back(&edit);
  const auto start = [](const Json* edit) { return range_from((*edit)["range"]).start; };
  // Those at the same place stay in their order.
  std::sort(sorted.begin(), sorted.end(), [&](const Json* a, const Json* b) {
    return start(a) != start(b) ? start(b) < start(a) : a < b;
  });
  Text result(std::move(text));
  for (const Json* edit : sorted) {
    result.replace(range_from((*edit)["range"]), (*edit)["newText"].get<std::string>(),
                   Encoding::utf16);
  }
  return result.bytes();
}

}  // namespace robdef::lsp::testing
