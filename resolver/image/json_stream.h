// JSON that is written as it goes, in the layout of jsonText(): what grows with a run's frames is never held as a tree,
// which takes ten times the room of its text.
#pragma once
#include <ostream>
#include <string_view>

#include "image/json_text.h"

namespace aa {

class JsonStream {
  public:
    // The whole document is an object; `inside` writes its members.
    template <class Inside>
    static void write(std::ostream& out, const Inside& inside) {
        JsonStream stream(out);
        stream.scope('{', '}', [&] { inside(stream); });
    }
    void value(std::string_view key, const nlohmann::ordered_json& value);
    template <class Inside>
    void object(std::string_view key, const Inside& inside) {
        begin(key);
        scope('{', '}', inside);
    }
    // `inside` calls element() for each.
    template <class Inside>
    void list(std::string_view key, const Inside& inside) {
        begin(key);
        scope('[', ']', inside);
    }
    template <class Inside>
    void element(const Inside& inside) {
        nextLine();
        scope('{', '}', inside);
    }

  private:
    explicit JsonStream(std::ostream& out) : out_(out) {}
    void nextLine();
    void begin(std::string_view key);
    template <class Inside>
    void scope(char open, char close, const Inside& inside) {
        out_ << open;
        depth_++;
        isEmpty_ = true;
        inside();
        depth_--;
        if (!isEmpty_) endLine();
        out_ << close;
        isEmpty_ = false;
    }
    void endLine();

    std::ostream& out_;
    int depth_ = 0;
    bool isEmpty_ = true;  // the object or list that is open
};

}  // namespace aa
