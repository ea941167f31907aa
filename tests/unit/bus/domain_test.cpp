// Joining a domain and leaving it.
#include "idl/domain.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <thread>

#include "support/process.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// CYCLONEDDS_URI unset, until it is set again as it was.
class WithoutConfiguration
{
public:
    WithoutConfiguration()
    {
        if (const char* uri = std::getenv("CYCLONEDDS_URI")) before_ = uri;
        (void)unsetenv("CYCLONEDDS_URI");
    }
    WithoutConfiguration(const WithoutConfiguration&) = delete;
    WithoutConfiguration& operator=(const WithoutConfiguration&) = delete;
    ~WithoutConfiguration()
    {
        if (before_) (void)setenv("CYCLONEDDS_URI", before_->c_str(), 1);
    }

private:
    std::optional<std::string> before_;
};

}  // namespace

TEST_CASE("the last participant to leave closes the domain: no thread and no socket remains")
{
    const WithoutConfiguration unset;
    const wire::DomainOptions options{160 + static_cast<std::uint32_t>(getpid()) % 40, {}};
    const int before = threads_of(getpid());
    {
        auto first = wire::join(options);
        REQUIRE(first.ok());
        auto second = wire::join(options);
        REQUIRE(second.ok());
        CHECK(threads_of(getpid()) > before);
        first->reset();
        CHECK(threads_of(getpid()) > before);
        CHECK(wire::make_publisher(*second, "still").ok());
    }
    // The kernel lists a joined thread for a moment longer.
    for (int i = 0; i < 200 && threads_of(getpid()) != before; ++i) std::this_thread::sleep_for(Milliseconds(5));
    CHECK(threads_of(getpid()) == before);
    auto again = wire::join(options);
    REQUIRE(again.ok());
    CHECK(wire::make_publisher(*again, "again").ok());
}
