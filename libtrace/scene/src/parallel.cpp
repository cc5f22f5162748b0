namespace atrium::scene {}
