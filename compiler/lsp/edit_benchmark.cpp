// SPDX-License-Identifier: Apache-2.0
// How long an edit takes from the message to its diagnostics, by the clock and of the own time of
// this process, which a busy machine does not lengthen: lsp_edit_benchmark [LINES [EDITS]].
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "compiler/lsp/server.hpp"

namespace {

using robdef::lsp::Json;

// Structs and objects of ten lines each that use one another.
std::string definition(int lines) {
  std::string text = "service example.large\nstdver 0.10\n\n";
  for (int block = 0; block * 20 < lines; ++block) {
    const std::string number = std::to_string(block);
    text += "## A record, and what it is for.\nstruct Record" + number + "\n";
    for (int field = 0; field < 6; ++field) {
      text += "    field double[] value" + std::to_string(field) + "\n";
    }
    text += "end\n\nobject Object" + number + "\n";
    for (int member = 0; member < 4; ++member) {
      const std::string name = std::to_string(member);
      text += "    property Record" + number + " state" + name + " [readonly]\n";
      text += "    function double call" + name + "(double a, Record" + number + " b)\n";
    }
    text += "end\n\n";
  }
  return text;
}

double at(const std::vector<double>& sorted, double part) {
  return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

int main(int count, char** words) {
  const int lines = count > 1 ? std::atoi(words[1]) : 20'000;
  const int edits = count > 2 ? std::atoi(words[2]) : 200;
  if (lines < 20 || edits < 1) return 2;
  std::size_t published = 0;
  robdef::lsp::Server server({},
                             [&](const Json& message) { published += message.contains("method"); });
  const auto notify = [&](const char* method, Json params) {
    server.take({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
  };
  server.take(
      {{"jsonrpc", "2.0"}, {"id", 1}, {"method", "initialize"}, {"params", Json::object()}});
  notify(
      "textDocument/didOpen",
      {{"textDocument", {{"uri", "untitled:large"}, {"version", 1}, {"text", definition(lines)}}}});
  server.publish();
  std::vector<double> times;
  std::vector<double> own;
  for (int edit = 0; edit < edits; ++edit) {
    // A letter is typed into the name of a field, and taken away.
    const int line = 3 + 20 * ((edit / 2 * 7919) % (lines / 20)) + 3;
    const int end = edit % 2 == 0 ? 26 : 27;
    const Json change = {{"range",
                          {{"start", {{"line", line}, {"character", 26}}},
                           {"end", {{"line", line}, {"character", end}}}}},
                         {"text", edit % 2 == 0 ? "x" : ""}};
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t own_begin = std::clock();
    notify("textDocument/didChange",
           {{"textDocument", {{"uri", "untitled:large"}, {"version", edit}}},
            {"contentChanges", Json::array({change})}});
    server.publish();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count());
    own.push_back(1000.0 * static_cast<double>(std::clock() - own_begin) / CLOCKS_PER_SEC);
  }
  std::ranges::sort(times);
  std::ranges::sort(own);
  std::printf(
      "%d lines, %d edits, %zu times diagnostics: p50 %.1f ms, p99 %.1f ms; own time p50 %.1f ms, "
      "p99 %.1f ms\n",
      lines, edits, published, at(times, 0.5), at(times, 0.99), at(own, 0.5), at(own, 0.99));
}
