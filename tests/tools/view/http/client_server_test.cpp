#include "tools/view/http/client_server.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <thread>

namespace houghstream::view {
namespace {

socket_t open_socket() {
  return socket(AF_INET, SOCK_STREAM, 0);
}

TEST(ClientTable, WhoHasWaitedLongestYieldsWhereOthersAreInWant) {
  ClientTable clients(4);
  const socket_t first = open_socket(), second = open_socket(), working = open_socket(), late = open_socket();
  for (const socket_t client : {first, second, working}) {
    EXPECT_TRUE(clients.admit(client));
    clients.begin(client);
  }
  clients.note_waiting(first);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  clients.note_waiting(second);
  EXPECT_FALSE(clients.must_yield(first)) << "not so soon";
  std::this_thread::sleep_for(ClientTable::kGrace);
  EXPECT_FALSE(clients.must_yield(first)) << "nobody is in want";
  EXPECT_TRUE(clients.admit(late));
  clients.note_waiting(first);
  EXPECT_TRUE(clients.must_yield(first)) << "it has waited since it was noted first";
  EXPECT_FALSE(clients.must_yield(second));
  EXPECT_FALSE(clients.must_yield(working));
  clients.begin(late);
  EXPECT_FALSE(clients.must_yield(first));
  EXPECT_FALSE(clients.admit(open_socket())) << "a fifth";
  clients.note_working(first);
  for (const socket_t client : {first, second, working, late}) clients.remove(client);
}

TEST(ClientTable, NobodyComesAfterItsEnd) {
  ClientTable clients(4);
  const socket_t client = open_socket();
  EXPECT_TRUE(clients.admit(client));
  clients.close();
  EXPECT_FALSE(clients.admit(open_socket()));
  clients.remove(client);
}

}  // namespace
}  // namespace houghstream::view
