// The guarantees of the transport, over the wire between threads.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <ostream>
#include <thread>

#include "protocol/transport.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

constexpr Address kRig{Role::rig, 0}, kTire{Role::tire, 0}, kTerrain{Role::terrain, 0};

double wall_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
void sleep_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// Runs `work` on all nodes. @returns each node's error as "4: text", empty if there is none
std::vector<std::string> play(int tires, const std::function<void(Transport&)>& work) {
  auto transports = make_in_process_transports(tires);
  std::vector<std::string> ends(transports.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < transports.size(); ++i)
    threads.emplace_back([&, i] {
      try {
        work(*transports[i]);
      } catch (const PeerFailure& failure) {
        ends[i] = "left " + std::to_string(static_cast<int>(failure.code())) + " for " + to_string(failure.who()) +
                  ": " + failure.what();
      } catch (const Error& error) {
        ends[i] = std::to_string(static_cast<int>(error.code())) + ": " + error.what();
        transports[i]->announce_failure(error.code(), error.what());
      }
    });
  for (auto& thread : threads) thread.join();
  return ends;
}

NodeCard card_of(const Transport& transport) {
  NodeCard card;
  card.self = transport.self();
  card.scenario_digest = "abc";
  card.step = 1e-4;
  card.steps = 100;
  card.wheel_count = transport.self() == kRig ? transport.tire_count() : 0;
  card.tire_count = transport.self().role == Role::tire ? 0 : transport.tire_count();
  card.tire_radius = 0.1 * (1 + transport.self().index);
  return card;
}

TEST(InProcess, messages_keep_their_order_per_kind) {
  const auto ends = play(2, [](Transport& t) {
    if (t.self() == kRig) {
      for (int step = 0; step < 50; ++step) {
        RimMotion motion;
        motion.header.step = step;
        send(t, kTire, motion);
        TerrainSetup setup;
        setup.grains = step;
        send(t, kTire, setup);
      }
    } else if (t.self() == kTire) {
      for (int step = 0; step < 50; ++step) EXPECT_EQ(receive<TerrainSetup>(t, kRig).grains, step);
      for (int step = 0; step < 50; ++step) EXPECT_EQ(receive_step<RimMotion>(t, kRig, step).header.step, step);
    }
  });
  EXPECT_EQ(ends, std::vector<std::string>(4));
}

TEST(InProcess, a_message_of_another_step_is_refused_by_name) {
  const auto ends = play(1, [](Transport& t) {
    if (t.self() == kRig) send(t, kTire, RimMotion{{7, 0.0}, {}, Order::go_on});
    if (t.self() == kTire) receive_step<RimMotion>(t, kRig, 8);
  });
  EXPECT_EQ(ends[1], "4: tire 0 expected step 8 from rig but got step 7");
}

TEST(Handshake, every_node_gets_every_card_in_order) {
  const auto ends = play(3, [](Transport& t) {
    const auto cards = handshake(t, card_of(t));
    ASSERT_EQ(cards.size(), 5U);
    EXPECT_EQ(cards[0].self, kRig);
    EXPECT_EQ(cards[2].self, (Address{Role::tire, 1}));
    EXPECT_DOUBLE_EQ(cards[3].tire_radius, 0.3);
    EXPECT_EQ(cards[4].self, kTerrain);
  });
  EXPECT_EQ(ends, std::vector<std::string>(5));
}

struct Mismatch {
  const char* name;
  std::function<void(NodeCard&)> spoil;  // the card of one node
  Address where;
  std::string text;  // part of the error
};

void PrintTo(const Mismatch& mismatch, std::ostream* out) { *out << mismatch.name; }

class HandshakeMismatch : public ::testing::TestWithParam<Mismatch> {};

TEST_P(HandshakeMismatch, is_the_same_error_on_every_node) {
  const auto ends = play(2, [](Transport& t) {
    NodeCard card = card_of(t);
    if (t.self() == GetParam().where) GetParam().spoil(card);
    handshake(t, card);
  });
  EXPECT_EQ(ends[0].substr(0, 14), "2: handshake: ") << ends[0];
  EXPECT_TRUE(holds(ends[0], GetParam().text));
  for (const std::size_t i : {1, 2, 3}) EXPECT_EQ(ends[i], "left 2 for rig: " + ends[0].substr(3));
}

INSTANTIATE_TEST_SUITE_P(
    Cards, HandshakeMismatch,
    ::testing::Values(
        Mismatch{"version", [](NodeCard& c) { c.protocol_version = 99; }, kTerrain,
                 "protocol version of rig is " + std::to_string(kProtocolVersion)},
        Mismatch{"digest", [](NodeCard& c) { c.scenario_digest = "xyz"; }, {Role::tire, 1}, "scenario digest of rig"},
        Mismatch{"step", [](NodeCard& c) { c.step = 2e-4; }, kTire, "communication step of rig is 0.0001"},
        Mismatch{"steps", [](NodeCard& c) { c.steps = 3; }, kTerrain, "number of steps of rig is 100"},
        Mismatch{"substeps", [](NodeCard& c) { c.substeps = 0; }, kTire, "tire 0 takes 0 substeps"},
        Mismatch{"wheels", [](NodeCard& c) { c.wheel_count = 4; }, kRig, "carries 4 wheel(s)"},
        Mismatch{"tires", [](NodeCard& c) { c.tire_count = 1; }, kTerrain, "the terrain expects 1 tire(s)"},
        Mismatch{"rig_tires", [](NodeCard& c) { c.tire_count = 1; }, kRig, "the rig expects 1 tire(s)"},
        Mismatch{"two_rigs", [](NodeCard& c) { c.self = kRig; }, kTire, "tire 0 calls itself rig"}),
    [](const auto& info) { return info.param.name; });

TEST(Failure, reaches_all_nodes_and_stays) {
  const auto ends = play(2, [](Transport& t) {
    if (t.self() == kTire) throw physics_error("no convergence");
    try {
      receive<TerrainSetup>(t, t.self() == kTerrain ? kRig : kTerrain);
    } catch (const PeerFailure&) {
      EXPECT_THROW(t.check_peers(), PeerFailure);
      throw;
    }
  });
  EXPECT_EQ(ends[1], "3: no convergence");
  for (const std::size_t i : {0, 2, 3}) EXPECT_EQ(ends[i], "left 3 for tire 0: no convergence");
}

TEST(Failure, is_seen_by_a_node_that_works_long) {
  const auto ends = play(1, [](Transport& t) {
    if (t.self() == kRig) throw io_error("results", "no space left");
    for (const double end = wall_s() + 5.0; wall_s() < end;) t.check_peers();
  });
  EXPECT_EQ(ends[2], "left 5 for rig: results: no space left");
}

TEST(TimeOut, says_who_waited_for_whom) {
  const double start = wall_s();
  const auto ends = play(1, [](Transport& t) {
    t.set_peer_timeout(0.3);
    if (t.self() == kTerrain) receive<SurfaceMotion>(t, kTire);
  });
  EXPECT_EQ(ends[2],
            "4: terrain waited 0.3 s for tire 0 (surface motion): tire 0 does not answer; raise "
            "run.peer_timeout if it "
            "is only slow");
  EXPECT_LT(wall_s() - start, 2.0);
}

// The rig waits for the terrain, which waits for the silent tire: the error names the tire.
TEST(TimeOut, names_the_node_at_the_end_of_a_chain_of_waiting) {
  const auto ends = play(1, [](Transport& t) {
    t.set_peer_timeout(t.self() == kRig ? 0.6 : 3.0);
    if (t.self() == kTerrain) receive<SurfaceMotion>(t, kTire);
    if (t.self() == kRig) {
      sleep_for(1.0);  // by now the terrain has reported that it waits
      receive<TerrainReport>(t, kTerrain);
    }
  });
  EXPECT_EQ(ends[0],
            "4: rig waited 0.6 s for terrain (terrain report), which waits for tire 0: tire 0 does not "
            "answer; raise "
            "run.peer_timeout if it is only slow");
}

TEST(TimeOut, finds_nodes_that_wait_for_one_another) {
  const auto ends = play(1, [](Transport& t) {
    t.set_peer_timeout(t.self() == kRig ? 0.8 : 0.9);
    if (t.self() == kRig) receive<SpindleReport>(t, kTire);
    if (t.self() == kTire) receive<RimMotion>(t, kRig);
  });
  EXPECT_EQ(ends[0],
            "4: rig waited 0.8 s for tire 0 (spindle report), which waits for rig: the nodes wait for one "
            "another");
}

// While the terrain settles its bed, the rig waits for it and the tire for the rig.
TEST(Heartbeat, keeps_the_peer_and_those_who_wait_for_it_alive) {
  const auto ends = play(1, [](Transport& t) {
    t.set_peer_timeout(1.3);
    if (t.self() == kTerrain) {
      for (const double end = wall_s() + 2.6; wall_s() < end; sleep_for(0.02)) t.heartbeat();
      send(t, kRig, TerrainSetup{});
    } else if (t.self() == kRig) {
      receive<TerrainSetup>(t, kTerrain);
      send(t, kTire, RimMotion{});
    } else {
      receive<RimMotion>(t, kRig);
      EXPECT_GT(t.wait_clock().waited_s, 2.5);
    }
  });
  EXPECT_EQ(ends, std::vector<std::string>(3));
}

TEST(Heartbeat, does_not_keep_a_circle_of_waiting_nodes_alive) {
  const double start = wall_s();
  const auto ends = play(1, [](Transport& t) {
    t.set_peer_timeout(0.7);
    t.heartbeat();
    if (t.self() == kRig) receive<TerrainReport>(t, kTerrain);
    if (t.self() == kTerrain) receive<SurfaceMotion>(t, kTire);
    if (t.self() == kTire) receive<RimMotion>(t, kRig);
  });
  EXPECT_LT(wall_s() - start, 3.0);
  int timed_out = 0;
  for (const std::string& end : ends) timed_out += end.substr(0, 2) == "4:";
  EXPECT_GE(timed_out, 1);
}

TEST(WaitClock, counts_the_time_blocked_in_receive) {
  play(1, [](Transport& t) {
    if (t.self() == kTerrain) {
      sleep_for(0.3);
      send(t, kRig, TerrainSetup{});
    }
    if (t.self() == kRig) {
      receive<TerrainSetup>(t, kTerrain);
      EXPECT_GE(t.wait_clock().waited_s, 0.25);
    }
  });
}

TEST(Transport, an_address_that_does_not_exist_is_refused) {
  const auto ends = play(1, [](Transport& t) {
    if (t.self() == kRig) send(t, Address{Role::tire, 1}, RimMotion{});
  });
  EXPECT_EQ(ends[0], "4: rig addressed tire 1, which does not exist");
}

}  // namespace
}  // namespace furrow
