/// The questions of the table behind one type, of double.
#include "question_of.h"

template std::span<const hedgerow::AnyQuestion<double, 2>* const> hedgerow::any_questions<double, 2>();
template std::span<const hedgerow::AnyQuestion<double, 3>* const> hedgerow::any_questions<double, 3>();
template const hedgerow::AnyQuestion<double, 2>* hedgerow::any_question<double, 2>(std::string_view,
                                                                                   std::string_view);
template const hedgerow::AnyQuestion<double, 3>* hedgerow::any_question<double, 3>(std::string_view,
                                                                                   std::string_view);
