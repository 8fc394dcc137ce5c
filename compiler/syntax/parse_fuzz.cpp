// SPDX-License-Identifier: Apache-2.0
// Any bytes at all are a definition or a list of findings, each of which can be printed.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "compiler/diagnostics/render.hpp"
#include "compiler/syntax/dump.hpp"
#include "compiler/syntax/parse.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace robdef;
  Sources sources;
  const SourceId id = sources.add("input.robdef", {reinterpret_cast<const char*>(data), size});
  Report report;
  const ast::File file = ast::parse(sources[id], id, report);
  for (const Diagnostic* diagnostic : report.sorted()) {
    const Span span = diagnostic->primary().span;
    if (span.begin > span.end || span.end > size) std::abort();
  }
  render(report, sources, Format::text);
  render(report, sources, Format::json);
  render(report, sources, Format::line);
  ast::dump(file, sources[id]);
  return 0;
}
