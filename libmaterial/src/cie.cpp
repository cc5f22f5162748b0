namespace atrium::material {}
