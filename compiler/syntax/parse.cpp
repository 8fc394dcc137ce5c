// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/parse.hpp"

#include "compiler/syntax/doubts.hpp"
#include "compiler/syntax/file_parser.hpp"
#include "compiler/syntax/types.hpp"

namespace robdef::ast {

File parse(const Source& source, SourceId id, Report& report) {
  File file = syntax::FileParser(source, id, report).run();
  syntax::doubt_names(file, report);
  syntax::doubt_types(file, report);
  return file;
}

}  // namespace robdef::ast
