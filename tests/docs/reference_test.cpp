// server/docs/reference.md is what `plabd --reference` prints. Renew it with that command when a declaration changed.
#include <fstream>
#include <sstream>

#include "blueprint/writer.h"
#include "support/scene.h"

TEST_CASE("the reference of component types is current")
{
    std::ifstream file(std::string(PLAB_SOURCE_DIR) + "/server/docs/reference.md");
    REQUIRE(file);
    std::stringstream text;
    text << file.rdbuf();
    CHECK_MESSAGE(text.str() == plab::blueprint::write_reference(plab::test::library()),
                  "run: build/bin/plabd --reference > server/docs/reference.md");
}
