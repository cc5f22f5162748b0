# Installed headers are the libraries' include/ folders verbatim.
