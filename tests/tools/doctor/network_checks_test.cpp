#include "tools/doctor/network_checks.hpp"

#include <gtest/gtest.h>

#include "pipeline/bus/receive_buffer.hpp"
#include "tests/tools/doctor/healthy_machine.hpp"

namespace houghstream::doctor {
namespace {

using Level = Finding::Level;

const BusSettings kBus{"udpm://239.255.76.67:7667?ttl=0", "FRAMES", 1'500'000};
const std::string kColumns = "Iface\tDestination\tGateway\tFlags\tRefCnt\tUse\tMetric\tMask\tMTU\tWindow\tIRTT\n";

/// Returns a line of /proc/net/route.
std::string route(const std::string& name, const std::string& destination, int metric, const std::string& mask) {
  return name + "\t" + destination + "\t00000000\t0001\t0\t0\t" + std::to_string(metric) + "\t" + mask + "\t0\t0\t0\n";
}

std::string way_with(const std::string& routes) {
  const HealthyMachine healthy("network_routes");
  plant(healthy.machine.root / "proc/net/route", kColumns + routes);
  return check_network(healthy.machine, kBus).front().what;
}

TEST(NetworkChecks, TheNarrowestRouteCountsThenTheSmallestMetric) {
  const std::string anywhere = route("any", "00000000", 0, "00000000");
  const std::string wide = route("wide", "000000E0", 5, "000000F0");
  const std::string narrow = route("narrow", "434CFFEF", 900, "FFFFFFFF");
  EXPECT_EQ(way_with(anywhere + route("away", "000200C0", 0, "00FFFFFF")), "239.255.76.67 goes through any");
  EXPECT_EQ(way_with(wide + anywhere), "239.255.76.67 goes through wide");
  EXPECT_EQ(way_with(narrow + wide + anywhere), "239.255.76.67 goes through narrow");
  EXPECT_EQ(way_with(wide + route("near", "000000E0", 4, "000000F0")), "239.255.76.67 goes through near");
  EXPECT_EQ(way_with("damaged\n"), "no route to 239.255.76.67: LCM cannot send");
}

TEST(NetworkChecks, AUrlThatStatesNoGroupIsOfLcmsOwn) {
  const HealthyMachine healthy("network_own_group");
  for (const char* url : {"udpm://", "udpm://?ttl=1", "udpm://239.255.76.67", "udpm://239.255.76.67?ttl=0"}) {
    BusSettings bus = kBus;
    bus.url = url;
    EXPECT_EQ(check_network(healthy.machine, bus).front().what, "239.255.76.67 goes through lo") << url;
  }
}

TEST(NetworkChecks, WithoutARouteTheBusIsLeftAlone) {
  HealthyMachine healthy("network_no_route");
  plant(healthy.machine.root / "proc/net/route", kColumns);
  int uses = 0;
  healthy.machine.heard_bytes = [&](const std::string&, const std::string&) {
    return static_cast<std::size_t>(++uses);
  };
  healthy.machine.self_test = [&](const std::string&, std::size_t) { return SelfTest{++uses, 0, ""}; };
  const Findings findings = check_network(healthy.machine, kBus);
  EXPECT_EQ(uses, 0);
  ASSERT_EQ(findings.size(), 5U);
  EXPECT_EQ(findings.front().level, Level::kWrong);
  EXPECT_EQ(findings.back().level, Level::kNote);
}

TEST(NetworkChecks, BuffersThatAreJustLargeEnoughForTheFramesHeardAreFine) {
  HealthyMachine healthy("network_buffers");
  constexpr std::size_t kHeard = 2'000'000;
  const std::int64_t needed = needed_receive_buffer(kHeard);
  std::string channel;
  healthy.machine.heard_bytes = [&](const std::string&, const std::string& name) {
    channel = name;
    return kHeard;
  };
  std::size_t tested = 0;
  healthy.machine.self_test = [&](const std::string&, std::size_t bytes) {
    tested = bytes;
    return SelfTest{5, 5, ""};
  };
  for (const std::int64_t missing : {0, 1}) {
    healthy.machine.granted_receive_buffer = [&](std::int64_t) { return needed - missing; };
    plant(healthy.machine.root / "proc/sys/net/core/rmem_default", std::to_string(needed - missing));
    const Findings findings = check_network(healthy.machine, kBus);
    ASSERT_EQ(findings.size(), 5U);
    EXPECT_EQ(findings[1].level, missing == 0 ? Level::kOk : Level::kWrong) << findings[1].what;
    EXPECT_EQ(findings[2].level, missing == 0 ? Level::kOk : Level::kNote) << findings[2].what;
  }
  EXPECT_EQ(channel, "FRAMES");
  EXPECT_EQ(tested, kHeard);
}

TEST(NetworkChecks, WhereNoFrameComesTheChannelsThatHaveSomeAreNamed) {
  HealthyMachine healthy("network_frames");
  healthy.machine.heard_frame_channels = [](const std::string&) { return std::set<std::string>{"LEFT", "RIGHT"}; };
  const Finding named = check_network(healthy.machine, kBus).back();
  EXPECT_EQ(named.level, Level::kNote);
  EXPECT_EQ(named.what, "no frame on FRAMES; frames come on LEFT, RIGHT");
  EXPECT_EQ(named.remedy.rfind("hs-detect -c LEFT", 0), 0U) << named.remedy;
  healthy.machine.heard_bytes = [](const std::string&, const std::string&) { return std::size_t{1'000}; };
  EXPECT_EQ(check_network(healthy.machine, kBus).size(), 5U) << "frames come where they are looked for";
}

TEST(NetworkChecks, WhatProcessesComplainOfIsToldCamerasThatContradictAreWrong) {
  HealthyMachine healthy("network_checks_processes");
  healthy.machine.heard_errors = [](const std::string&) {
    return std::map<std::string, std::string>{
        {"hs-pose", "no frame"},
        {"hs-track", "RIGHT sees objects 2.0 cm from where LEFT sees them: one of their places is wrong"}};
  };
  const Findings findings =
      check_network(healthy.machine, {"udpm://239.255.76.67:7667?ttl=0", "OPENNI_FRAME", 1000000});
  ASSERT_GE(findings.size(), 2U);
  const Finding& pose = findings[findings.size() - 2];
  const Finding& track = findings.back();
  EXPECT_EQ(pose.level, Finding::Level::kNote);
  EXPECT_EQ(pose.what, "says: no frame");
  EXPECT_EQ(track.level, Finding::Level::kWrong);
  EXPECT_EQ(track.name, "hs-track");
  EXPECT_NE(track.remedy.find("hs-track --check"), std::string::npos);
}

/// Returns a camera that adds so much to b* of three objects.
CameraChroma camera_with_cast(double b) {
  CameraChroma camera;
  camera.frame = {"LEFT", 1};
  for (const double a : {-30.0, 0.0, 20.0, 35.0}) {
    ChromaPair& pair = camera.objects.emplace_back();
    pair.class_name = std::to_string(a);
    pair.model = {a, 0.5 * a};
    pair.measured = {a, 0.5 * a + b};
    pair.lightness = 100.0;
    pair.probability = 0.95;
  }
  return camera;
}

TEST(NetworkChecks, ACameraWithAStrongCastShouldBeSetByHand) {
  HealthyMachine healthy("network_checks_colours");
  healthy.machine.heard_bytes = [](const std::string&, const std::string&) { return std::size_t{1'000}; };
  const auto told_of = [&](double cast) {
    healthy.machine.heard_camera_colours = [=](const std::string&) {
      return std::vector<CameraChroma>{camera_with_cast(cast)};
    };
    return check_network(healthy.machine, kBus).back();
  };
  EXPECT_EQ(told_of(2.0).level, Level::kOk);
  const Finding strong = told_of(30.0);
  EXPECT_EQ(strong.level, Level::kNote);
  EXPECT_EQ(strong.what.rfind("LEFT: saturation ", 0), 0U) << strong.what;
  EXPECT_NE(strong.what.find("white balance"), std::string::npos) << strong.what;
}

TEST(NetworkChecks, ACameraWhoseDepthIsOfAnotherTimeIsToldOf) {
  HealthyMachine healthy("network_checks_timing");
  healthy.machine.heard_bytes = [](const std::string&, const std::string&) { return std::size_t{1'000}; };
  const auto told_of = [&](double lag_s, double sigma_s) {
    healthy.machine.heard_camera_timings = [=](const std::string&) {
      return std::vector<CameraTiming>{{{"LEFT", 1}, lag_s, sigma_s}};
    };
    return check_network(healthy.machine, kBus).back();
  };
  EXPECT_EQ(told_of(0.002, 0.001).level, Level::kOk);
  EXPECT_EQ(told_of(-0.008, 0.002).level, Level::kOk) << "it may be less";
  const Finding apart = told_of(-0.0114, 0.001);
  EXPECT_EQ(apart.level, Level::kNote);
  EXPECT_EQ(apart.what.rfind("LEFT: depth is 11 ms older than colours, give or take 2", 0), 0U) << apart.what;
}

TEST(NetworkChecks, WhatProcessesSayDoesNotSteerATerminal) {
  HealthyMachine healthy("network_checks_rubbish");
  healthy.machine.heard_errors = [](const std::string&) {
    return std::map<std::string, std::string>{{"hs\033[2J", std::string(5000, '\a')}};
  };
  const Finding said = check_network(healthy.machine, kBus).back();
  EXPECT_EQ(said.name, "hs\\x1b[2J");
  EXPECT_EQ(said.what.substr(0, 14), "says: \\x07\\x07");
  EXPECT_LE(said.what.size(), 6U + 4U * 300U);
}

TEST(NetworkChecks, WhoMaySendIsSaidWithWhatKeepsOthersOut) {
  HealthyMachine healthy("network_senders");
  healthy.machine.refuses_others = [](const std::string&) { return false; };
  const auto senders = [&](const std::string& url) {
    BusSettings bus = kBus;
    bus.url = url;
    const Findings findings = check_network(healthy.machine, bus);
    return findings[findings.size() - 2];
  };
  const Finding own = senders(kBus.url);
  EXPECT_EQ(own.level, Level::kNote);
  EXPECT_NE(own.remedy.find("udp dport 7667 drop"), std::string::npos) << own.remedy;
  EXPECT_EQ(senders("udpm://239.255.76.67:7667?ttl=1").level, Level::kNote);
  EXPECT_NE(senders("tcpq://localhost").remedy.find("tcp dport 7700 drop"), std::string::npos);
  EXPECT_NE(senders("tcpq://10.0.0.2:7800").remedy.find("tcp dport 7800 drop"), std::string::npos);
  EXPECT_EQ(senders("udpm://?ttl=1").level, Level::kNote) << "LCM's own group";
  EXPECT_EQ(senders("memq://").level, Level::kOk);
  healthy.machine.refuses_others = [](const std::string& port) { return port == "7667"; };
  EXPECT_EQ(senders(kBus.url).level, Level::kOk);
}

}  // namespace
}  // namespace houghstream::doctor
