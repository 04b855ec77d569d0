#include "platform/service_notifier.hpp"

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

/// Stands in for systemd: "@" begins the name of an abstract socket, as in NOTIFY_SOCKET.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& name) : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name.data(), name.size());
    if (name.front() == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~NotifySocket() {
    ::unsetenv("NOTIFY_SOCKET");
    ::close(socket_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// The next message; empty where there is none.
  [[nodiscard]] std::string next() const {
    char buffer[512];
    const ssize_t size = ::recv(socket_, buffer, sizeof buffer, MSG_DONTWAIT);
    return size < 0 ? std::string() : std::string(buffer, static_cast<std::size_t>(size));
  }

 private:
  int socket_;
};

class ServiceNotifierTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!LANDFIX_HAS_SYSTEMD) GTEST_SKIP() << "built without libsystemd";
  }
  void TearDown() override {
    ::unsetenv("WATCHDOG_USEC");
    ::unsetenv("WATCHDOG_PID");
  }
};

void expect_messages(const NotifySocket& systemd) {
  const ServiceNotifier notifier;
  EXPECT_TRUE(notifier.is_listened_to());
  notifier.ready("NO_DATA, waiting for vlp16");
  EXPECT_EQ(systemd.next(), "READY=1\nSTATUS=NO_DATA, waiting for vlp16");
  notifier.status("TRACKING\nREADY=1");
  EXPECT_EQ(systemd.next(), "STATUS=TRACKING READY=1");
  notifier.alive();
  EXPECT_EQ(systemd.next(), "WATCHDOG=1");
  notifier.stopping("SIGTERM");
  EXPECT_EQ(systemd.next(), "STOPPING=1\nSTATUS=SIGTERM");
  EXPECT_EQ(systemd.next(), "");
}

TEST_F(ServiceNotifierTest, TellsWhatHappens) {
  const test::TemporaryDirectory directory;
  expect_messages(NotifySocket((directory.path() / "notify").string()));
}

TEST_F(ServiceNotifierTest, TellsItToAnAbstractSocketToo) {
  expect_messages(NotifySocket("@landfix-test-" + std::to_string(::getpid())));
}

TEST_F(ServiceNotifierTest, IsAliveTwiceAsOftenAsTheWatchdogLooks) {
  const NotifySocket systemd("@landfix-test-" + std::to_string(::getpid()));
  EXPECT_FALSE(ServiceNotifier().alive_period_ns());
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  EXPECT_EQ(ServiceNotifier().alive_period_ns(), 1'000'000'000);
  ::setenv("WATCHDOG_PID", std::to_string(::getpid()).c_str(), 1);
  EXPECT_EQ(ServiceNotifier().alive_period_ns(), 1'000'000'000);
  ::setenv("WATCHDOG_PID", "1", 1);  // meant for another process
  EXPECT_FALSE(ServiceNotifier().alive_period_ns());
  ::setenv("WATCHDOG_USEC", "often", 1);
  EXPECT_FALSE(ServiceNotifier().alive_period_ns());
}

TEST_F(ServiceNotifierTest, DoesNothingWhereNobodyListens) {
  ::unsetenv("NOTIFY_SOCKET");
  ::setenv("WATCHDOG_USEC", "2000000", 1);
  const ServiceNotifier notifier;
  EXPECT_FALSE(notifier.is_listened_to());
  EXPECT_FALSE(notifier.alive_period_ns());
  notifier.ready("");
  notifier.alive();
}

TEST_F(ServiceNotifierTest, DoesNotMindAListenerThatIsGone) {
  ::setenv("NOTIFY_SOCKET", "/nonexistent/notify", 1);
  const ServiceNotifier notifier;
  notifier.ready("");
  notifier.alive();
  ::unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace landfix::platform
