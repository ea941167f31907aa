/// A plugin for the library's tests; SAMPLE_... says what is wrong with it.
#include "plab/plugin.h"

namespace
{

struct Rows
{
    plab::Column<double> value;
    void describe(plab::Schema& schema) { schema.param(value, "value", plab::unit::metre, "a length").or_else(2).positive(); }
};

[[maybe_unused]] void add_types([[maybe_unused]] plab::Registrar& registrar)
{
#if defined(SAMPLE_THROWS)
    throw 1;
#elif !defined(SAMPLE_EMPTY)
    registrar.component<Rows>("Sample/Good", "works").host_command(plab::Phase::Finish, "Sample/Finish", "does nothing");
    registrar.component<Rows>("Sample/Better", "works, too");
#endif
#if defined(SAMPLE_TWICE)
    registrar.component<Rows>("Sample/Good", "again");
#endif
}

}  // namespace

#if !defined(SAMPLE_STAMP)
extern "C" PLAB_EXPORT const plab::PluginStamp plab_plugin_stamp
{
#if defined(SAMPLE_VERSION)
    plab::kSdkVersion + 1,
#else
    plab::kSdkVersion,
#endif
#if defined(SAMPLE_SIZE)
        sizeof(plab::PluginStamp) + 8,
#else
        sizeof(plab::PluginStamp),
#endif
#if defined(SAMPLE_LAYOUT)
        42,
#else
        plab::layout_stamp(),
#endif
#if defined(SAMPLE_NAME)
        nullptr,
#else
        "sample",
#endif
        __VERSION__
};
#endif

#if !defined(SAMPLE_ENTRY)
extern "C" PLAB_EXPORT void plab_plugin_register(plab::Registrar& registrar) { add_types(registrar); }
#endif
