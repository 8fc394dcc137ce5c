// SPDX-License-Identifier: Apache-2.0
#include "cli/live/commands.hpp"

#include <iostream>
#include <optional>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <span>
#include <string>

#include "cli/live/complete.hpp"
#include "cli/live/connection.hpp"
#include "cli/live/describe.hpp"
#include "cli/live/members.hpp"
#include "cli/live/prompt.hpp"
#include "cli/live/top.hpp"
#include "cli/live/watch.hpp"
#include "cli/options.hpp"

namespace robdef {
namespace {

std::optional<std::string> next_line() {
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  return line;
}

void describe(const Options& options, std::ostream& out) {
  const live::Connection connection(more(options).live, options.inputs[0]);
  const std::string path = options.inputs.size() > 1 ? options.inputs[1] : "";
  if (options.format == Format::json) {
    live::describe_json(connection.root(), path, out);
  } else {
    live::describe_text(connection.root(), path, out);
  }
}

void complete(const Options& options, std::ostream& out) {
  const live::Connection connection(more(options).live, options.inputs[1]);
  const std::string word = options.inputs.size() > 2 ? options.inputs[2] : "";
  for (const std::string& each :
       live::completions(connection.root(), {}, options.inputs[0], word)) {
    out << rr::printable(each) << '\n';
  }
}

ExitStatus answer(const Options& options, std::ostream& out, std::ostream& err) {
  const std::span<const std::string> inputs = options.inputs;
  switch (options.command) {
    case Command::describe:
      describe(options, out);
      break;
    case Command::get: {
      const live::Connection connection(more(options).live, inputs[0]);
      for (const std::string& member : inputs.subspan(1)) {
        live::get(connection.root(), member, more(options).live, out);
      }
      break;
    }
    case Command::set:
      live::set(live::Connection(more(options).live, inputs[0]).root(), inputs[1], inputs[2],
                more(options).live);
      break;
    case Command::call:
      live::call(live::Connection(more(options).live, inputs[0]).root(), inputs[1],
                 inputs.subspan(2), more(options).live, next_line, out);
      break;
    case Command::watch:
      return live::watch_service(inputs[0], inputs.subspan(1), more(options).live, out, err);
    case Command::top:
      return live::top(inputs[0], inputs.subspan(1), more(options).live, out);
    case Command::connect:
      return live::prompt(inputs[0], more(options).live, out, err);
    case Command::complete:
      complete(options, out);
      break;
    default:
      break;
  }
  return exit_fine;
}

}  // namespace

bool is_url(std::string_view text) { return text.find("://") != std::string_view::npos; }

ExitStatus run_live(const Options& options, std::ostream& out, std::ostream& err) {
  try {
    return answer(options, out, err);
  } catch (const rr::Error& error) {
    out.flush();
    err << "robdef: " << rr::printable(error.what(), longest_message) << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
