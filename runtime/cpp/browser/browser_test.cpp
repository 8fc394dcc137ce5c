// SPDX-License-Identifier: Apache-2.0
// A page in a real browser as client: Chromium, or what the variable ROBDEF_BROWSER names and takes
// its flags.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/page_server.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

std::string page() {
  std::ostringstream text;
  text << std::ifstream(BROWSER_PAGE).rdbuf();
  return text.str();
}

TEST(Browsers, APageThatIsAllowedConnectsAndAnotherDoesNot) {
  const char* const named = std::getenv("ROBDEF_BROWSER");
  const char* const program = named != nullptr ? named : BROWSER_PROGRAM;
  PageServer pages(page());
  const std::string origin = "http://127.0.0.1:" + std::to_string(pages.port());

  Node allowing({.name = "allowing.node", .web_socket = {.origins = {origin}}});
  Node other({.name = "other.node", .web_socket = {.origins = {"https://panel.example"}}});
  for (Node* const node : {&allowing, &other}) {
    const auto object = std::make_shared<Counter>();
    object->set_value(42.5);
    node->register_service("counter", object);
  }
  const std::string address = origin +
                              "/?allowed=" + std::to_string(allowing.listen_tcp(0, "127.0.0.1")) +
                              "&other=" + std::to_string(other.listen_tcp(0, "127.0.0.1"));

  const std::string profile = test_folder() + "/browser";
  Child browser({"--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
                 "--disable-background-networking", "--disable-dev-shm-usage",
                 "--user-data-dir=" + profile, address},
                program);
  EXPECT_EQ(pages.wait_for("/result?"), "allowed=allowing.node%3A42.5&other=refused");
  browser.signal(SIGTERM);  // it ends its own processes
  int status = 0;
  EXPECT_TRUE(browser.wait(std::chrono::seconds(20), status));
}

}  // namespace
}  // namespace rr::testing
