/// The questions of the table behind one type, of float.
#include "question_of.h"

template std::span<const hedgerow::AnyQuestion<float, 2>* const> hedgerow::any_questions<float, 2>();
template std::span<const hedgerow::AnyQuestion<float, 3>* const> hedgerow::any_questions<float, 3>();
template const hedgerow::AnyQuestion<float, 2>* hedgerow::any_question<float, 2>(std::string_view,
                                                                                 std::string_view);
template const hedgerow::AnyQuestion<float, 3>* hedgerow::any_question<float, 3>(std::string_view,
                                                                                 std::string_view);
