namespace atrium::trace {}
