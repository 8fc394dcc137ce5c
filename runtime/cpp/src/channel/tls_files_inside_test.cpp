// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/tls_files.hpp"

namespace rr::channel {
namespace {

TEST(TlsFiles, WithoutFilesTheLibraryIsStartedWhenItIsNeeded) {
  TlsFiles files({}, NodeId::random());
  EXPECT_FALSE(files.is_in_use());
  files.look_again(false);
  EXPECT_FALSE(files.is_in_use());
  const auto trust = files.trust();
  ASSERT_NE(trust, nullptr);
  EXPECT_NE(trust->context, nullptr);
  EXPECT_NE(trust->nodes, nullptr);
  EXPECT_TRUE(files.is_in_use());
  EXPECT_EQ(files.trust(), trust);
}

TEST(TlsFiles, OnesThatCannotBeUsedAreRefusedAtOnce) {
  EXPECT_THROW(TlsFiles({.certificate_file = "/nowhere/node.pem"}, NodeId::random()), Error);
  EXPECT_THROW(TlsFiles({.authority_files = {"/nowhere/ca.pem"}}, NodeId::random()), Error);
  EXPECT_THROW(TlsFiles({.revocation_files = {"/nowhere/list.pem"}}, NodeId::random()), Error);
}

}  // namespace
}  // namespace rr::channel
