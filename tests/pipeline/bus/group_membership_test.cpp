#include "pipeline/bus/group_membership.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

namespace houghstream {
namespace {

constexpr const char* kGroup = "239.255.76.67";
constexpr int kSkipped = 77;

bool run(const std::string& command) {
  return std::system((command + " 2>/dev/null").c_str()) == 0;
}

bool plug_in() {
  return run("ip link add end_a type veth peer name end_b") && run("ip addr add 10.77.0.1/24 dev end_a") &&
         run("ip link set end_a up") && run("ip link set end_b up") && run("ip route add 224.0.0.0/4 dev end_a");
}

/// This process gets a network of its own, of which it is root: the programs that it starts may change it.
bool enter_own_network() {
  const std::string user = "0 " + std::to_string(getuid()) + " 1";
  const std::string group = "0 " + std::to_string(getgid()) + " 1";
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  for (const auto& [file, text] : {std::pair<const char*, std::string>{"/proc/self/setgroups", "deny"},
                                   {"/proc/self/uid_map", user},
                                   {"/proc/self/gid_map", group}}) {
    if (!(std::ofstream(file) << text).flush()) return false;
  }
  return true;
}

/// Returns the exit status of `body` in a process with a network of its own.
int in_own_network(const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) _exit(enter_own_network() && plug_in() ? body() : kSkipped);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Returns a socket that receives what is sent to the group once it has joined it.
int receiving_socket() {
  const int socket_fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(7667);
  inet_pton(AF_INET, kGroup, &address.sin_addr);
  return bind(socket_fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? socket_fd : -1;
}

bool is_received(int socket_fd) {
  const int sender = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(7667);
  inet_pton(AF_INET, kGroup, &to.sin_addr);
  const bool is_sent = sendto(sender, "x", 1, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 1;
  close(sender);
  char byte = 0;
  return is_sent && recv(socket_fd, &byte, 1, 0) == 1;
}

TEST(GroupMembership, ComesBackWithAnotherInterfaceHoweverOften) {
  const int status = in_own_network([] {
    const int receiver = receiving_socket();
    if (receiver < 0 || !join_group(receiver, kGroup) || !is_received(receiver)) return 1;
    if (!join_group(receiver, kGroup) || !is_received(receiver)) return 2;  // again
    constexpr int kMoreThanTheKernelAllows = 25;
    for (int i = 0; i < kMoreThanTheKernelAllows; ++i) {
      if (!run("ip link del end_a")) return 3;
      if (join_group(receiver, kGroup)) return 4;  // there is no route
      if (!plug_in() || is_received(receiver)) return 5;
      if (!join_group(receiver, kGroup) || !is_received(receiver)) return 6;
    }
    return 0;
  });
  if (status == kSkipped) GTEST_SKIP() << "no network namespaces or veth here";
  EXPECT_EQ(status, 0);
}

TEST(GroupMembership, WhatIsNoGroupIsRefused) {
  const int receiver = receiving_socket();
  EXPECT_FALSE(join_group(receiver, "127.0.0.1"));
  EXPECT_FALSE(join_group(receiver, "nowhere"));
  close(receiver);
}

}  // namespace
}  // namespace houghstream
