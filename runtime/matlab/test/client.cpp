// SPDX-License-Identifier: Apache-2.0
// A client in C++ of the rig that the tests serve from Octave: `matlab_test_client URL` says what
// is not as it should be, or `as expected`.
#include <cstdio>
#include <future>
#include <stdexcept>
#include <string>

#include "rr/dynamic.hpp"
#include "rr/error.hpp"
#include "rr/node.hpp"

namespace {

using rr::dynamic::List;
using rr::dynamic::StringMap;
using rr::dynamic::Value;

void expect(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

void use_values(const rr::dynamic::Client& rig) {
  rig->set("speed", 7);
  expect(rig->get("speed").as<double>() == 7, "speed");
  rig->set("note", StringMap{{"text", "n"}, {"numbers", List{1, 2, 3}}});
  expect(rig->get("note")["numbers"].size() == 3, "note");
  expect(rig->get("mode").text() == "busy", "mode");
  for (int i = 0; i < 20; ++i) expect(rig->call("add", {i, 1}).as<int>() == i + 1, "add");
  try {
    rig->call("jam", {"stuck"});
    expect(false, "jam");
  } catch (const rr::Error& error) {
    expect(error.name() == "experimental.rig.Jam" && error.message() == "stuck", "what jam says");
  }
  expect(rig->object("children", 4).call("name").text() == "child 4", "children");
  const rr::dynamic::Memory grid = rig->memory("grid");
  expect(grid.read({0, 0}, grid.dims()).at(1).as<int>() == 4, "grid");
}

void use_streams(const rr::dynamic::Client& rig) {
  rr::dynamic::Generator values = rig->generate("count_to", {2});
  expect(values.next()->as<int>() == 0 && values.next()->as<int>() == 1 && !values.next(),
         "count_to");
  rig->callback("ask").set(
      [](const List& arguments) -> Value { return "asked " + arguments.at(0).text(); });
  expect(rig->call("ask_back", {"me"}).text() == "asked me", "ask_back");
  std::promise<int> fired;
  const rr::Subscription subscription = rig->on_event(
      "changed", [&](const List& arguments) { fired.set_value(arguments.at(0).as<int>()); });
  rig->call("fire", {1});
  expect(fired.get_future().get() == 1, "changed");
  rr::dynamic::PipeEndpoint end = rig->pipe("samples").connect();
  end.send(StringMap{{"id", 3}, {"at", List{1, 2, 3}}});
  const auto packet = end.receive_for(std::chrono::seconds(20));
  expect(packet && (*packet)["id"].as<int>() == 3, "samples");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fputs("usage: matlab_test_client URL\n", stderr);
    return 2;
  }
  rr::Node node;
  const rr::dynamic::Client rig = rr::dynamic::connect(node, argv[1]);
  use_values(rig);
  use_streams(rig);
  std::puts("as expected");
  return 0;
} catch (const std::exception& error) {
  std::printf("%s\n", error.what());
  return 1;
}
