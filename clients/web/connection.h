/// The link to one server while it is there.
#pragma once

#include <functional>
#include <map>
#include <optional>

#include "link/frame_reader.h"
#include "web/contacts.h"
#include "web/feed_hooks.h"
#include "web/hands.h"
#include "web/history.h"
#include "web/pose_encoder.h"
#include "web/preview.h"

namespace plab::web
{

class Connection
{
public:
    /// Waits for the whole catalogue. The session must outlive it.
    static Result<std::unique_ptr<Connection>> open(const link::Session& session, const link::SessionOptions& options, Audience& pages,
                                                    const FeedHooks& hooks);

    /// Waits for what the server sends, a few milliseconds, and passes it on; true if pages got something.
    bool step();
    /// It has gone, or another one has taken its name.
    bool is_over() const { return is_over_; }
    /// Pages whose requests were not answered are told.
    void close();

private:
    Connection(const link::Session& session, Audience& pages, FeedHooks hooks, link::Caller caller)
        : session_(session),
          pages_(pages),
          hooks_(std::move(hooks)),
          requests_(std::move(caller)),
          hands_(session, requests_),
          contacts_(session)
    {
    }

    void take_pages();
    void handle(const Arrived& arrived);
    void ask(PageId page, const Ask& ask);
    void answer(PageId page, std::uint64_t id, const Result<link::Reply>& reply);
    void leave(PageId page);
    void take_frames();
    void take_catalogue();
    void take_metrics();
    void note_figures();
    void take_events();
    void send_details();
    void begin_pages();
    void subscribe();
    void push(const Json& message);
    void push_to(PageId page, const Json& message);
    std::set<std::string> watched() const;

    const link::Session& session_;
    Audience& pages_;
    FeedHooks hooks_;
    link::Requests requests_;
    Hands hands_;
    ContactFeed contacts_;
    link::SessionOptions options_;  ///< with the server's name
    Preview preview_;
    std::optional<link::Catalogue> catalogue_;
    link::CatalogueContents sent_;  ///< what the pages know
    std::uint64_t version_ = 0;
    std::chrono::steady_clock::time_point compared_at_{}, noted_at_{};
    std::int64_t started_ns_ = 0;
    double metrics_time_ = -1;
    std::uint64_t metrics_run_ = 0;
    std::int64_t server_step_ = -1;

    // Read only while there are pages.
    std::optional<link::FrameReader> frames_;
    std::optional<wire::DataReader<plab_v2_Collisions>> collisions_;
    wire::DataReader<plab_v2_Events> events_;

    PoseEncoder encoder_;
    History history_;
    std::map<PageId, std::set<std::string>> watched_;
    std::map<std::string, std::string> details_;  ///< as they were sent last
    MessagePtr whole_;                            ///< of sent_; null: to be made
    bool has_news_ = false, is_over_ = false;
};

}  // namespace plab::web
