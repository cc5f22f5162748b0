namespace atrium::radiosity {}
