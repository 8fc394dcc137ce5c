// SPDX-License-Identifier: Apache-2.0
#include "gateway/nats_subjects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace rr::gateway {
namespace {

using ::testing::ElementsAre;

TEST(NatsSubjects, OfTheGatewaysTopicsReadAsTheyAre) {
  EXPECT_EQ(subject_of("rr/hall-1/robot_7/$life"), "rr.hall-1.robot_7.$life");
  EXPECT_EQ(subject_of("rr/h/r/s/$call/eve/tools[left%20arm]/open"),
            "rr.h.r.s.$call.eve.tools[left%20arm].open");
}

TEST(NatsSubjects, HaveOtherLettersEncoded) {
  EXPECT_EQ(subject_of("a.b/*/>/~"), "a~2Eb.~2A.~3E.~7E");
  EXPECT_EQ(subject_of("a b/\t\r\n"), "a~20b.~09~0D~0A");
  EXPECT_EQ(subject_of(std::string("\0", 1)), "~00");
  EXPECT_EQ(subject_of("/a//"), "~.a.~.~");
  EXPECT_EQ(subject_of("h\xC3\xA4nde"), "h\xC3\xA4nde");
}

// All topics of up to four letters that are likely to collide.
TEST(NatsSubjects, AreReversibleAndNeverTheSame) {
  constexpr std::string_view letters = "/.~*>2E a";
  std::set<std::string> subjects;
  std::size_t topics = 0;
  std::vector<std::string> all{""};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].size() < 4) {
      for (const char letter : letters) all.push_back(all[i] + letter);
    }
    const std::string subject = subject_of(all[i]);
    EXPECT_EQ(topic_of(subject), all[i]);
    EXPECT_EQ(subject.find_first_of(" *>/"), std::string::npos) << subject;
    EXPECT_FALSE(subject.starts_with('.') || subject.ends_with('.')) << subject;
    EXPECT_EQ(subject.find(".."), std::string::npos) << subject;
    subjects.insert(subject);
    ++topics;
  }
  EXPECT_EQ(topics, 7'381U);
  EXPECT_EQ(subjects.size(), topics);
}

TEST(NatsSubjects, ThatNoTopicHasAreNone) {
  for (const char* subject :
       {"", "a..b", "a.", "a/b", "a.*", "a.>", "~2", "~2e", "~41", "~zz", "a b"}) {
    EXPECT_EQ(topic_of(subject), std::nullopt) << subject;
  }
}

TEST(NatsSubjects, OfFiltersHaveWildcards) {
  EXPECT_THAT(subjects_of_filter("rr/+/+/$life"), ElementsAre("rr.*.*.$life"));
  EXPECT_THAT(subjects_of_filter("rr/h/r/s/$def/#"),
              ElementsAre("rr.h.r.s.$def", "rr.h.r.s.$def.>"));
  EXPECT_THAT(subjects_of_filter("#"), ElementsAre(">"));
  EXPECT_THAT(subjects_of_filter("a/*/>"), ElementsAre("a.~2A.~3E"));
}

TEST(NatsSubjects, OfRetainedMessagesAreApart) {
  EXPECT_EQ(kept_subject("rr.hall.r1.$life"), "rrkept.hall.r1.$life");
  EXPECT_EQ(subject_of_kept("rrkept.hall.r1.$life"), "rr.hall.r1.$life");
  EXPECT_EQ(kept_subject("rrr.hall"), std::nullopt);
  EXPECT_EQ(kept_subject("life"), std::nullopt);
  EXPECT_EQ(subject_of_kept("rr.hall"), std::nullopt);
}

TEST(NatsSubjects, OfBeatsAreBelowLives) {
  EXPECT_TRUE(is_life_topic("rr/hall/r1/$life"));
  EXPECT_TRUE(is_life_topic("rr/+/+/$life"));
  EXPECT_FALSE(is_life_topic("rr/hall/r1/arm/afterlife"));
  EXPECT_EQ(life_of_beats(beat_topic("rr/hall/r1/$life")), "rr/hall/r1/$life");
  EXPECT_EQ(life_of_beats("rr/hall/r1/$life"), std::nullopt);
}

TEST(NatsSubjects, OfInboxesBelongToUsers) {
  EXPECT_EQ(inbox_prefix("alice"), "_INBOX.alice");
  EXPECT_EQ(inbox_prefix("a.b"), "_INBOX.a~2Eb");
  EXPECT_EQ(inbox_prefix(""), "_INBOX");
}

}  // namespace
}  // namespace rr::gateway
