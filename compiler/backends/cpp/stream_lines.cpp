// SPDX-License-Identifier: Apache-2.0
// Members that give a handle and have no parameters: pipes, wires, memories.
#include "compiler/backends/cpp/layout.hpp"
#include "compiler/backends/cpp/member_lines.hpp"

namespace robdef::cpp {
namespace {

std::string handing_out(const MemberView& view, const std::string& type, const std::string& after) {
  return definition({.result = type, .name = view.name, .after = after},
                    "return {*this, " + view.entry + "};", in_class);
}

}  // namespace

void lay_out_pipe(MemberView& view) {
  view.handle = "::rr::Pipe<" + view.type + ">";
  view.served = "::rr::PipeServer<" + view.type + ">";
  view.stub_handle = handing_out(view, view.handle, "");
  view.skeleton_handle = handing_out(view, view.served, " const");
}

void lay_out_wire(MemberView& view) {
  view.handle = "::rr::Wire<" + view.type + ">";
  view.served = "::rr::WireServer<" + view.type + ">";
  view.stub_handle = handing_out(view, view.handle, "");
  view.skeleton_handle = handing_out(view, view.served, " const");
}

void lay_out_memory(MemberView& view) {
  const std::string shape = view.is_multi ? "Multi" : "Array";
  const std::string source = "::rr::" + shape + "MemorySource<" + view.item + ">";
  view.handle = "::rr::" + shape + "Memory<" + view.item + ">";
  view.served = "::std::shared_ptr<" + source + ">";
  view.stub_handle = handing_out(view, view.handle, "");
  view.skeleton_handle = declaration(
      {.before = "virtual ", .result = view.served, .name = view.name, .after = " = 0"}, in_class);
  view.dispatch_find = "return " + view.name + "();";
  const std::string stored = stored_name(view);
  view.default_find = definition({.result = view.served, .name = view.name, .after = " override"},
                                 "return " + stored + ";", in_class);
  const std::string made =
      "::std::make_shared<::rr::Stored" + shape + "Memory<" + view.item + ">>()";
  view.stored = assignment(view.served + " " + stored, made, in_class);
}

}  // namespace robdef::cpp
