/// Moments from a recording: all of them, as fast as they are drawn.
#pragma once

#include <set>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"
#include "idl/recording/sample_header.h"
#include "idl/recording/whole_frame.h"
#include "viewer/source.h"

namespace plab::view
{

class FileSource final : public Source
{
public:
    /// Begins at the last state before `from` (s, simulated, of the first run in the file), or with the first one.
    static Result<std::unique_ptr<Source>> open(const std::string& file, std::optional<double> from);

    /// Without waiting.
    std::optional<Moment> pop(link::Seconds timeout) override;
    std::optional<std::string> closed() const override { return closed_; }
    std::uint64_t given_up() const override { return 0; }
    std::shared_ptr<const link::CatalogueContents> scene() const override { return shown_; }
    std::optional<link::ServerInfo> server() const override;

private:
    /// A message of the catalogue that was read, but is not due yet.
    using Ahead = std::optional<recording::Found>;

    FileSource(recording::McapReader reader) : reader_(std::move(reader)) {}
    void start(std::optional<double> from);
    std::uint64_t frame_that_leads_to(std::uint64_t first, std::uint64_t ahead) const;
    bool decode_frame(const recording::Found& found);
    std::optional<recording::Found> next_frame();
    void follow_scene(const recording::Message& frame, bool is_new);
    bool is_of_later(const recording::Found& found);
    Ahead& ahead();
    void apply(const recording::Found& found);
    void erase(const std::string& topic, const std::string& id);
    void show(std::uint64_t time);
    std::optional<Moment> only_catalogue();

    recording::McapReader reader_;
    std::optional<recording::Cursor> frames_, catalogue_;
    Ahead ahead_;
    std::map<std::string, std::unique_ptr<recording::Peek>> peeks_;
    recording::Decoder decoder_;
    recording::Sample<plab_v2_Frame> frame_;
    recording::WholeFrame whole_;
    link::CatalogueContents now_;
    bool is_changed_ = true, any_ = false;
    std::uint64_t run_ = 0, revision_ = 0;
    double time_ = 0;
    std::uint64_t broken_ = 0;
    std::shared_ptr<const link::CatalogueContents> shown_;
    std::optional<std::string> closed_;
};

}  // namespace plab::view
