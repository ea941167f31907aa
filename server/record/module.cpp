// What record.so exports. No exception may cross the module's boundary.
#include <exception>

#include "record/file_log.h"
#include "record/recorder.h"

namespace
{

template <class T, class Open>
std::unique_ptr<T> guarded(plab::Error& error, const char* what, Open open)
{
    try
    {
        auto opened = open();
        if (opened) return opened.take();
        error = opened.error();
    }
    catch (const std::exception& e)
    {
        error = plab::reason(std::string(what) + ": " + e.what());
    }
    return nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) std::unique_ptr<plab::record::Recording> plab_record_open(
    const plab::record::RecordOptions& options, plab::Error& error)
{
    return guarded<plab::record::Recording>(error, "cannot record", [&] { return plab::record::Recorder::open(options); });
}
static_assert(std::is_same_v<plab::record::OpenRecording, decltype(&plab_record_open)>);

extern "C" __attribute__((visibility("default"))) std::unique_ptr<plab::record::RunLog> plab_record_read(const std::string& file,
                                                                                                         plab::Error& error)
{
    return guarded<plab::record::RunLog>(error, "cannot read the recording", [&] { return plab::record::FileLog::open(file); });
}
static_assert(std::is_same_v<plab::record::OpenRunLog, decltype(&plab_record_read)>);
