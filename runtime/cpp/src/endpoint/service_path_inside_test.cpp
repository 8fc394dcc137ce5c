// SPDX-License-Identifier: Apache-2.0
// Where objects and services are: paths, and the URLs that others have told.
#include <gtest/gtest.h>

#include <string>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/found_urls.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"

namespace rr::endpoint {
namespace {

TEST(ServicePath, IsStepsWithIndices) {
  const auto path = parse_path("arm.tool[a%20B_].tip[7]");
  ASSERT_TRUE(path);
  ASSERT_EQ(path->size(), 3U);
  EXPECT_EQ((*path)[0], (PathSegment{"arm", std::nullopt}));
  EXPECT_EQ((*path)[1], (PathSegment{"tool", "a B_"}));
  EXPECT_EQ((*path)[2], (PathSegment{"tip", "7"}));
}

TEST(ServicePath, WhatIsNoneIsRefused) {
  for (const char* text : {"", ".", "a.", ".a", "a..b", "1a", "a_", "a[1]", "a.b[]", "a.b[1",
                           "a.b1]", "a.b[%2]", "a.b[%2g]", "a.b[ ]", "a.b[1]c", "a.b[%]"}) {
    EXPECT_FALSE(parse_path(text)) << text;
  }
}

TEST(ServicePath, HasOneSpelling) {
  EXPECT_EQ(escape_index("aZ0"), "aZ0");
  EXPECT_EQ(escape_index("a_ \xff"), "a%5f%20%ff");
  const auto path = parse_path("arm.tool[a%2Db_]");
  ASSERT_TRUE(path);
  EXPECT_EQ(canonical_path(*path), "arm.tool[a%2db%5f]");
}

TEST(ServicePath, IsAboveOthers) {
  EXPECT_TRUE(is_at_or_below("arm", "arm"));
  EXPECT_TRUE(is_at_or_below("arm.tool", "arm"));
  EXPECT_FALSE(is_at_or_below("arms", "arm"));
  EXPECT_FALSE(is_at_or_below("arm", "arm.tool"));
  EXPECT_FALSE(is_at_or_below("arm[1]", "arm"));
}

TEST(ClientVersion, IsTwoToFourNumbers) {
  EXPECT_EQ(parse_version("0.10"), (DefinitionVersion{0, 10, 0, 0}));
  EXPECT_EQ(parse_version("1.2.3.4"), (DefinitionVersion{1, 2, 3, 4}));
  EXPECT_EQ(parse_version(own_version), (DefinitionVersion{1, 2, 8, 0}));
  for (const char* text : {"", "1", "1.", "1.2.3.4.5", "1.x", "-1.0", "1..2", "1.99999999999"}) {
    EXPECT_THROW(parse_version(text), Error) << text;
  }
}

TEST(FoundUrls, AreKnownWhateverServiceTheyName) {
  FoundUrls found;
  const auto contains = [&](const char* url) { return found.contains(Url::parse(url)); };
  found.add({"rr+tcp://10.0.0.1:2355/?nodename=a&service=one", "no url"});
  EXPECT_TRUE(contains("rr+tcp://10.0.0.1:2355/?nodename=a&service=other"));
  EXPECT_TRUE(contains("rr+tcp://10.0.0.1:2355?service=other&nodename=a"));
  EXPECT_FALSE(contains("rr+tcp://10.0.0.1:2356/?nodename=a&service=one"));
  EXPECT_FALSE(contains("rr+tcps://10.0.0.1:2355/?nodename=a&service=one"));
  EXPECT_FALSE(contains("rr+tcp://10.0.0.1:2355/?nodename=b&service=one"));
  EXPECT_FALSE(contains("rr+tcp://10.0.0.1:2355/?service=one"));
}

TEST(FoundUrls, TheOldestAreForgotten) {
  FoundUrls found;
  const auto url = [](std::size_t number) {
    return "rr+tcp://host" + std::to_string(number) + ":1/?service=s";
  };
  for (std::size_t i = 0; i <= FoundUrls::capacity; ++i) found.add({url(i)});
  EXPECT_FALSE(found.contains(Url::parse(url(0))));
  EXPECT_TRUE(found.contains(Url::parse(url(1))));
  EXPECT_TRUE(found.contains(Url::parse(url(FoundUrls::capacity))));
}

TEST(ServiceUrls, NameTheNodeAndTheService) {
  const NodeId id = NodeId::random();
  const auto parsed = [](const std::string& url) { return Url::parse(url); };
  const Url there = parsed(service_index::service_url("rr+tcp://[fe80::1%eth0]:2355", id, "arm"));
  EXPECT_EQ(there.host, "fe80::1");
  EXPECT_EQ(there.port, 2355);
  EXPECT_EQ(there.node_id, id);
  EXPECT_EQ(there.service, "arm");
  const Url here =
      parsed(service_index::own_service_url("rr+tcp://[fe80::1%eth0]:2355", id, "arm"));
  EXPECT_EQ(here.host, "fe80::1%eth0");
  EXPECT_EQ(here.service, "arm");
  const std::string url = service_index::service_url("rr+tcp://10.0.0.1:2355", id, "arm");
  const Url other = parsed(service_index::exchange_service(url, "leg"));
  EXPECT_EQ(other.service, "leg");
  EXPECT_EQ(other.node_id, id);
  EXPECT_EQ(other.host, "10.0.0.1");
  EXPECT_EQ(service_index::exchange_service(url, "").find("service"), std::string::npos);
  const service_index::IndexStub stub;
  EXPECT_EQ(&stub.rr_object_type(), &service_index::index_stub_type);
}

}  // namespace
}  // namespace rr::endpoint
