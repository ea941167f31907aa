/// A run log in the file of a recording.
#pragma once

#include <map>
#include <set>

#include "idl/recording/cdr.h"
#include "idl/recording/format.h"
#include "record/run_log.h"

namespace plab::record
{

class FileLog final : public RunLog
{
public:
    static Result<std::unique_ptr<FileLog>> open(const std::string& file);

    const std::vector<RecordedSnapshot>& snapshots() const override { return snapshots_; }
    Result<wire::Snapshot> read(const RecordedSnapshot& snapshot) override;
    Result<std::vector<wire::Journal>> journal(std::uint64_t run) override;
    Result<void> begin_hashes(std::uint64_t run) override;
    Result<std::optional<wire::Hashes>> next_hashes() override;
    Result<std::optional<wire::Frame>> frame(std::uint64_t run, Tick step) override;
    Result<std::vector<std::pair<std::uint32_t, std::string>>> objects(std::uint64_t run) override;
    std::string origin(const std::string& key) const override;
    std::string damage() const override;

private:
    explicit FileLog(recording::McapReader reader) : reader_(std::move(reader)) {}
    /// A part of the time line in which a run has messages.
    struct Span
    {
        std::uint64_t from = 0, to = 0;
    };
    Result<void> list_snapshots();
    template <class T, class Use>
    Result<void> each(const recording::Query& query, Use use);
    recording::Query query_of(const char* topic, std::uint64_t run) const;

    recording::McapReader reader_;
    recording::Decoder decoder_;
    std::vector<RecordedSnapshot> snapshots_;
    std::map<std::uint64_t, std::uint64_t> begin_of_run_;  ///< log_time of its first snapshot
    std::optional<recording::Cursor> hashes_;
    std::uint64_t hash_run_ = 0;
    recording::Sample<plab_v2_Hashes> hash_sample_;
};

}  // namespace plab::record
