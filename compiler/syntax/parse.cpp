// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/parse.hpp"

#include "compiler/syntax/doubts.hpp"
#include "compiler/syntax/file_parser.hpp"
#include "compiler/syntax/types.hpp"

namespace robdef::ast {

namespace {

File with_doubts(File file, Report& report) {
  syntax::doubt_names(file, report);
  syntax::doubt_types(file, report);
  return file;
}

}  // namespace

File parse(const Source& source, SourceId id, Report& report) {
  return with_doubts(syntax::FileParser(source, id, report).run(), report);
}

File parse(const Source& source, SourceId id, Report& report, EarlierFile earlier) {
  return with_doubts(syntax::FileParser(source, id, report, &earlier).run(), report);
}

}  // namespace robdef::ast
