#include "daemon/recording.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "blueprint/writer.h"
#include "simulation/snapshot/build.h"
#include "simulation/snapshot/format.h"

namespace plab::daemon
{
namespace
{

constexpr std::size_t kMostSnapshotBytes = std::size_t(4) << 30;

}  // namespace

Result<RecordModule> RecordModule::load(const char* entry)
{
    auto module = plugins::open_module("record", entry, plugins::PluginLibrary::default_directories());
    if (!module) return module.errors();
    return RecordModule(module.take());
}

Result<std::unique_ptr<record::Recording>> RecordModule::record(const record::RecordOptions& options) const
{
    Error error;
    auto opened = reinterpret_cast<record::OpenRecording>(module_.entry)(options, error);
    if (!opened) return error;
    return opened;
}

Result<std::unique_ptr<record::RunLog>> RecordModule::read(const std::string& file) const
{
    Error error;
    auto opened = reinterpret_cast<record::OpenRunLog>(module_.entry)(file, error);
    if (!opened) return error;
    return opened;
}

record::RecordOptions record_options(const DaemonOptions& options, const simulation::Simulation& simulation, model::TypeSource& types)
{
    record::RecordOptions out;
    const RecordChoice& r = options.record;
    out.file = r.file, out.overwrite = r.overwrite, out.compression = r.compression, out.topics = r.topics;
    out.state_interval = r.state_interval, out.moved_only = r.moved_only, out.snapshot_interval = r.snapshot_interval;
    out.server = options.name, out.version = PLAB_VERSION, out.build = simulation::build_name();
    out.scene_file = options.scene.empty() ? options.load : options.scene;
    out.dt = simulation.dt(), out.threads = static_cast<std::uint32_t>(options.threads);
    out.blueprint = blueprint::write_long_form(simulation.world().scene(), types);
    return out;
}

std::string missing_for_replay(const RecordChoice& choice)
{
    std::string out;
    if (choice.topics.empty()) return out;
    for (const char* topic : {"plab/snapshots", "plab/journal", "plab/hashes"})
        if (std::find(choice.topics.begin(), choice.topics.end(), topic) == choice.topics.end())
            out += (out.empty() ? "" : ", ") + std::string(topic);
    return out;
}

simulation::HistoryOptions history_of(const DaemonOptions& options)
{
    simulation::HistoryOptions out;
    // Clients of a server may want to rewind; a batch computation needs no history.
    out.interval = options.history >= 0 ? options.history : options.bus ? 1 : 0;
    return out;
}

Result<void> write_snapshot(const simulation::Snapshot& snapshot, std::span<const std::string> waiting, const std::string& file)
{
    auto bytes = simulation::encode(snapshot, waiting);
    if (!bytes) return bytes.errors();
    const std::string part = file + ".part";
    std::FILE* f = std::fopen(part.c_str(), "wb");
    const bool written = f && std::fwrite(bytes->data(), 1, bytes->size(), f) == bytes->size() && std::fflush(f) == 0;
    const bool closed = f && std::fclose(f) == 0;
    if (written && closed && std::rename(part.c_str(), file.c_str()) == 0) return {};
    const std::string why = std::strerror(errno);
    (void)std::remove(part.c_str());
    return reason("cannot write " + file + ": " + why);
}

Result<simulation::SnapshotFile> read_snapshot(const std::string& file, model::TypeSource& types)
{
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) return reason("cannot read " + file + ": " + std::strerror(errno));
    const std::streamoff size = in.tellg();
    if (size < 0 || static_cast<std::size_t>(size) > kMostSnapshotBytes) return reason(file + ": is not a snapshot");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    in.seekg(0);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), size)) return reason("cannot read " + file);
    auto decoded = simulation::decode(bytes, types);
    if (!decoded)
    {
        Errors errors = decoded.errors();
        for (Error& e : errors)
            if (e.where.file.empty()) e.where.file = file;
        return errors;
    }
    return decoded;
}

}  // namespace plab::daemon
