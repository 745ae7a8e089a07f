// One client's connection: a request, and its answer or the stream. Every request has a connection of its own.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "drivers/viewer/view_server.h"

namespace edgeslam {

// Serves it, and lives as long as that takes. `server` must outlive its context's handlers. `is_full`: there are too
// many connections already, and this one is only told so.
void serveConnection(boost::asio::ip::tcp::socket socket, ViewServer& server, bool is_full);

}  // namespace edgeslam
